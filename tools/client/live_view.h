#pragma once
// The screen of `softgrip watch`: status with trends, the latest events, the result of the last key, and the
// key help. The keys are converted to requests to the daemon. The functions do not access a terminal or a
// socket.

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/client/daemon_text.h"

namespace softgrip::tools {

/// Converts the keys for stop and vent to requests at once. Start and release move the fingers, so they need
/// a confirmation: a key that the user types within `confirmation_timeout_s` after the question.
class KeyDialogue {
 public:
  static constexpr double confirmation_timeout_s = 10;

  struct Outcome {
    bool quit = false;
    std::optional<nlohmann::ordered_json> request;  ///< request to the daemon; nullopt: no request
  };
  /// Processes the keys that were typed since the last call. `last_sequence` is the name of the sequence that
  /// the start key offers; empty: the start key offers none. If a key causes a question, the keys that follow
  /// this key are dropped, so that pasted text cannot confirm the question. Arrow keys and function keys are
  /// ignored.
  Outcome process(std::string_view typed, double time_s, const std::string& last_sequence);
  /// Withdraws the question if it has waited for an answer for `confirmation_timeout_s`. Returns true if this
  /// call has withdrawn a question.
  bool expire(double time_s);

  /// Returns the question that waits for an answer; "" if there is none.
  [[nodiscard]] std::string question() const;
  /// Returns the help on the keys as one line of 58 columns.
  [[nodiscard]] static std::string_view help();

 private:
  enum class State : unsigned char { idle, reading_name, confirming };
  Outcome key(char key, double time_s, const std::string& last_sequence);
  Outcome name_key(char key, double time_s);
  void ask_confirmation(nlohmann::ordered_json request, std::string question, double time_s);

  State state_ = State::idle;
  double asked_at_s_ = 0;
  std::string name_;
  std::string proposed_name_;
  std::string question_;
  nlohmann::ordered_json request_;
};

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
