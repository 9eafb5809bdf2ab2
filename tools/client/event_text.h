#pragma once
// Formats events of the daemon as text lines.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// Formats an event of the socket API as "   12.340 s  warning  left: Grip result: NO PART.". If the event
/// has a time of day, the line begins with local time: "2026-11-21 09:32:05.123  warning  ...".
[[nodiscard]] std::string line_of_event(const nlohmann::ordered_json& event);

/// Replaces the control characters in each line of a text, so that a terminal does not execute them.
[[nodiscard]] std::string shown_lines(std::string_view text);

/// Formats the response to an acknowledgement: "acknowledged F202 reading_out_of_range of left; nothing moves
/// until the next start".
[[nodiscard]] std::string sentence_of_acknowledged(const nlohmann::ordered_json& result);

/// Formats an event for a narrow screen: "09:32:05 !  left: Grip result: NO PART.". `!` marks a warning and
/// `!!` an error.
[[nodiscard]] std::string brief_line_of_event(const nlohmann::ordered_json& event);

}  // namespace softgrip::tools
