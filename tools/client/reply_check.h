#pragma once
// The only place that checks lines of the daemon. In a checked line, all values that the programs read have
// the kinds of docs/reference/socket-api.md, so that readers need no further checks.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

namespace softgrip::tools {

/// Parses a line of the daemon: a reply, a state or an event. The error says what is malformed. Unknown keys
/// may have any kind, because a newer daemon may send more keys.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> parse_reply(std::string_view line);

}  // namespace softgrip::tools
