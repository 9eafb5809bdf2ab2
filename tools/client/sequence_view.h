#pragma once
// The daemon's list of sequences for people.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// One line per sequence, and below it one per parameter: name, range, unit, default, what it is. One that
/// cannot be started says why.
[[nodiscard]] std::vector<std::string> view_of_sequences(const nlohmann::ordered_json& sequences);

/// Their names alone.
[[nodiscard]] std::vector<std::string> names_of_sequences(const nlohmann::ordered_json& sequences);

}  // namespace softgrip::tools
