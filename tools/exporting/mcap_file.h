#pragma once
// Writes signals as MCAP version 0, the file format of Foxglove (https://mcap.dev/spec).

#include <string>
#include <vector>

#include "tools/exporting/signals.h"

namespace softgrip::tools {

/// Returns the bytes of a file with one topic per group and one JSON object per sample. The topic is "/left"
/// for the group "left" and "/signals" for a group without a name. The keys of an object are the names of the
/// signals and time_s, which is 0 at the start of the recording. A missing value has no key. The file is
/// uncompressed, indexed by chunks of at most 4 MiB, and has checksums.
[[nodiscard]] std::string mcap_bytes(const std::vector<SignalGroup>& groups, const std::string& library);

}  // namespace softgrip::tools
