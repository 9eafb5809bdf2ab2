#pragma once
// Checks lines of the daemon; no other code checks them. After the check, all fields that the programs read
// have the JSON types of docs/reference/socket-api.md, so that readers need no further checks.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

namespace softgrip::tools {

/// Parses a line of the daemon: a reply, a state or an event. The error says what is malformed. An unknown
/// key may have a value of any type, because a newer daemon may send additional keys.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> parse_reply(std::string_view line);

}  // namespace softgrip::tools
