#pragma once
// The one place where lines of the daemon are checked. What passes has the promised kinds in all places that
// the programs here read (docs/reference/socket-api.md), so that no reader meets another kind.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

namespace softgrip::tools {

/// Parses a line of the daemon: a reply, a state or an event. The error says what is malformed. Keys that
/// nobody here reads may be of any kind: a newer daemon may have more of them.
[[nodiscard]] tl::expected<nlohmann::ordered_json, std::string> parse_reply(std::string_view line);

}  // namespace softgrip::tools
