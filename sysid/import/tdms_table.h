#pragma once
// Reader of LabVIEW's binary measurement files (.tdms).

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Reads channels of numbers, booleans and time stamps, named "group/channel", with the property
/// `unit_string` as their unit. Waveforms get a column "wf_time" from wf_increment, wf_start_offset and
/// wf_start_time. Channels of text and channels that need a scale of NI are skipped, and a note names them.
/// If a file is cut off, its complete rows are read; a note states the bytes of the rest, and the account
/// counts its rows. Big-endian files, raw values of DAQmx and other types of values are refused.
[[nodiscard]] std::optional<ForeignTable> read_tdms_table(const std::string& file, std::string_view bytes,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
