#pragma once
// Checks all lines of the daemon. After the check, all fields that the programs read have the JSON types of
// docs/reference/socket-api.md, so the readers of the fields need no checks of their own.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

namespace softgrip::tools {

/// Parses a line of the daemon: a reply, a state or an event. The error describes the malformed part. An
/// unknown key may have a value of any type, because a newer daemon may send additional keys.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> parse_reply(std::string_view line);

}  // namespace softgrip::tools
