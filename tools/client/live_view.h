#pragma once
// The screen of `softgrip watch`: status with trends, the last events, what a key led to, the keys.

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/client/status_view.h"

namespace softgrip::tools {

/// What is known when the screen is drawn.
struct LiveState {
  nlohmann::ordered_json status;
  std::vector<ChannelTrends> trends;          ///< one per channel
  std::deque<nlohmann::ordered_json> events;  ///< the newest last
  std::string question;                       ///< that waits for a key; empty: none
  Span said;                                  ///< what the last key led to; empty: nothing yet
};

/// Events that are kept for the screen.
inline constexpr std::size_t events_shown = 50;

/// Takes a status into the state and its trends.
void take_status(LiveState& state, nlohmann::ordered_json status);
/// Takes an event; the oldest beyond events_shown is forgotten.
void take_event(LiveState& state, nlohmann::ordered_json event);

/// At most `rows` (> 0) lines. The keys are the last line, whatever the height; what does not fit above them
/// is left out with a line that says so, the events first.
[[nodiscard]] std::vector<std::string> screen_of(const LiveState& state, const ViewStyle& style,
                                                 std::size_t rows);

}  // namespace softgrip::tools
