#pragma once
// Reads the binary measurement files of LabVIEW (.tdms).

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads channels of numbers, booleans and time stamps, named "group/channel". The property `unit_string` of
/// a channel is its unit. For waveforms, a column "wf_time" is computed from wf_increment, wf_start_offset
/// and wf_start_time. Channels of text are skipped. Channels whose values require a scale of National
/// Instruments are skipped too. A note names all skipped channels. If the end of a file is missing, the
/// complete rows are read. A note states the number of unread bytes, and the account counts the rows that
/// they contain. Big-endian files, raw DAQmx values and other value types are refused.
[[nodiscard]] std::optional<ForeignTable> read_tdms_table(const std::string& file, std::string_view bytes,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
