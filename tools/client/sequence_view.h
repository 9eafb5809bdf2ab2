#pragma once
// Formats the daemon's list of sequences as text.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// Returns one line per sequence, followed by one line per parameter with name, range, unit, default and
/// description. If a sequence cannot be started, its line states the reason.
[[nodiscard]] std::vector<std::string> view_of_sequences(const nlohmann::ordered_json& sequences);

/// Returns the names of the sequences.
[[nodiscard]] std::vector<std::string> names_of_sequences(const nlohmann::ordered_json& sequences);

}  // namespace softgrip::tools
