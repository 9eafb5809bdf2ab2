#pragma once
// Reader of LabVIEW's binary measurement files (.tdms).

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads channels of numbers, booleans and time stamps, named "group/channel". The property `unit_string` is
/// their unit. For waveforms, a column "wf_time" is computed from wf_increment, wf_start_offset and
/// wf_start_time. Channels of text, and channels whose values need a scale of National Instruments, are
/// skipped, and a note names them. If the end of a file is missing, the complete rows are read. A note states
/// the number of bytes that were not read, and the account counts their rows. Big-endian files, raw values of
/// DAQmx and other types of values are refused.
[[nodiscard]] std::optional<ForeignTable> read_tdms_table(const std::string& file, std::string_view bytes,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
