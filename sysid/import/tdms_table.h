#pragma once
// LabVIEW's binary measurement files (.tdms).

#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Channels of numbers, booleans and time stamps, named "group/channel", with the property `unit_string` as
/// their unit. Waveforms get a column "wf_time" from wf_increment, wf_start_offset and wf_start_time.
/// Channels of text and channels that need a scale of NI are skipped and named. Of a file that is cut off the
/// complete rows are read; the bytes of the rest are stated, and its rows are in the account. Big-endian
/// files, the raw values of DAQmx and other types of values are refused.
[[nodiscard]] std::optional<ForeignTable> read_tdms_table(const std::string& file, std::string_view bytes,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
