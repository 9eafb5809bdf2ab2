#pragma once
// Signals as MCAP, the container that Foxglove reads (https://mcap.dev/spec), version 0.

#include <string>
#include <vector>

#include "tools/exporting/signals.h"

namespace softgrip::tools {

/// The bytes of a file: a topic per group ("/left", without a name "/signals"), a JSON object per sample, its
/// keys the signals' names and time_s. Times count from the recording's start. Not packed, indexed by chunks
/// of at most 4 MiB, with checksums. What is not there has no key.
[[nodiscard]] std::string mcap_bytes(const std::vector<SignalGroup>& groups, const std::string& library);

}  // namespace softgrip::tools
