#pragma once
// The screen of `softgrip watch`: status with trends, the latest events, the result of the last key, and the
// key help.

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/client/daemon_text.h"

namespace softgrip::tools {

/// The data from which the screen is drawn.
struct LiveState {
  nlohmann::ordered_json status;
  std::vector<ChannelTrends> trends;          ///< recent values of pressure and displacement, one element per
                                              ///< channel
  std::deque<nlohmann::ordered_json> events;  ///< the latest events of the daemon, the newest event last
  std::string question;                       ///< the question that waits for a key; empty if there is none
  Span message;                               ///< message about the last key; empty before the first key
};

/// Largest number of events that are kept for the screen.
inline constexpr std::size_t events_shown = 50;

/// Stores a status and updates the trends.
void update_status(LiveState& state, nlohmann::ordered_json status);
/// Stores an event. Drops the oldest event if there are more than `events_shown`.
void add_event(LiveState& state, nlohmann::ordered_json event);

/// Returns the screen as at most `rows` (> 0) lines. The last line is always the key help. If there are too
/// few rows, events are omitted first, and a line of the screen states this.
[[nodiscard]] std::vector<std::string> screen_of(const LiveState& state, const ViewStyle& style,
                                                 std::size_t rows);

}  // namespace softgrip::tools
