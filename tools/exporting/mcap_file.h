#pragma once
// Writes signals as MCAP, the container of Foxglove (https://mcap.dev/spec), version 0.

#include <string>
#include <vector>

#include "tools/exporting/signals.h"

namespace softgrip::tools {

/// Returns the bytes of a file with one topic per group ("/left"; "/signals" without a name) and one JSON
/// object per sample. Its keys are time_s, counted from the start of the recording, and the names of the
/// signals. Missing values have no key. The file is uncompressed, indexed by chunks of at most 4 MiB, and has
/// checksums.
[[nodiscard]] std::string mcap_bytes(const std::vector<SignalGroup>& groups, const std::string& library);

}  // namespace softgrip::tools
