#pragma once
// Fields of what the daemon says, which may be missing, null or of another kind.

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// The text at `key`, shortened to `most` characters and without control characters; "-" where there is none.
[[nodiscard]] std::string text_at(const nlohmann::ordered_json& json, const char* key,
                                  std::size_t most = 200);
[[nodiscard]] std::optional<double> number_at(const nlohmann::ordered_json& json, const char* key);
/// The object at `key`, or an empty one.
[[nodiscard]] const nlohmann::ordered_json& object_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace softgrip::tools
