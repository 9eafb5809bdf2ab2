#pragma once
// Checks all lines of the daemon. After the check, all fields that the programs read have the JSON types of
// docs/reference/socket-api.md, so the readers of the fields need no checks of their own.
// Reads fields of the daemon's messages that may be missing, null or of an unexpected JSON type.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

namespace softgrip::tools {

/// Parses a line of the daemon: a reply, a state or an event. The error describes the malformed part. An
/// unknown key may have a value of any type, because a newer daemon may send additional keys.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> parse_reply(std::string_view line);

/// Returns the text at `key` without control characters, shortened to `most` characters. Returns "-" if there
/// is no text.
[[nodiscard]] std::string text_at(const nlohmann::ordered_json& json, const char* key,
                                  std::size_t most = 200);
[[nodiscard]] std::optional<double> number_at(const nlohmann::ordered_json& json, const char* key);
/// Returns the object at `key`. Returns an empty object if there is no value, or if the value is not an
/// object.
[[nodiscard]] const nlohmann::ordered_json& object_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace softgrip::tools
