#pragma once
// Reads fields of the daemon's messages that may be missing, null or of an unexpected JSON type.

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// Returns the text at `key` without control characters, shortened to `most` characters. Returns "-" if there
/// is no text.
[[nodiscard]] std::string text_at(const nlohmann::ordered_json& json, const char* key,
                                  std::size_t most = 200);
[[nodiscard]] std::optional<double> number_at(const nlohmann::ordered_json& json, const char* key);
/// Returns the object at `key`. Returns an empty object if there is no value, or if the value is not an
/// object.
[[nodiscard]] const nlohmann::ordered_json& object_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace softgrip::tools
