#pragma once
// Events of the daemon as lines for people.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// "   12.340 s  warning  left: Grip result: NO PART." of an event as the socket API tells it; of one
/// that carries the time of day, "2026-11-21 09:32:05.123  warning  ..." in local time.
[[nodiscard]] std::string line_of_event(const nlohmann::ordered_json& event);

/// Text of several lines, line by line without what a terminal would obey.
[[nodiscard]] std::string shown_lines(std::string_view text);

/// "acknowledged F202 reading_out_of_range of left; nothing moves until the next start" of what the daemon
/// answers to an acknowledgement.
[[nodiscard]] std::string sentence_of_acknowledged(const nlohmann::ordered_json& result);

/// line_of_event() for a narrow screen: "09:32:05 !  left: Grip result: NO PART.", with `!` for a
/// warning and `!!` for an error.
[[nodiscard]] std::string brief_line_of_event(const nlohmann::ordered_json& event);

}  // namespace softgrip::tools
