#pragma once
// Formats events of the daemon as text lines.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

/// "   12.340 s  warning  left: Grip result: NO PART." of an event as the socket API reports it; for an event
/// with the time of day, "2026-11-21 09:32:05.123  warning  ..." in local time.
[[nodiscard]] std::string line_of_event(const nlohmann::ordered_json& event);

/// Replaces the control characters of a text line by line, so that a terminal does not execute them.
[[nodiscard]] std::string shown_lines(std::string_view text);

/// Formats the response to an acknowledgement: "acknowledged F202 reading_out_of_range of left; nothing moves
/// until the next start".
[[nodiscard]] std::string sentence_of_acknowledged(const nlohmann::ordered_json& result);

/// line_of_event() for a narrow screen: "09:32:05 !  left: Grip result: NO PART.", with `!` for a
/// warning and `!!` for an error.
[[nodiscard]] std::string brief_line_of_event(const nlohmann::ordered_json& event);

}  // namespace softgrip::tools
