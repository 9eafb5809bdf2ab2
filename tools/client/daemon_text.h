#pragma once
// Formats the daemon's messages as text: status, list of sequences, and events.
// Draws the recent values of a quantity as one line of characters.
// Reads the last result of `softgrip health` from the folder of the recordings.

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/styled_line.h"

namespace softgrip::tools {

/// The newest value of each second, for the last `seconds_kept` seconds. A second without a value is a gap.
class Trend {
 public:
  static constexpr std::size_t seconds_kept = 300;

  /// Adds a value at the time `time_s`. If `time_s` is smaller than in the last call, another daemon has
  /// started, and the trend begins again.
  void add(double time_s, std::optional<double> value);

  /// Returns at most `cells` characters, one per second, the newest second last. Each character is one column
  /// wide. The scale covers the shown values, and its span is at least `min_span` (> 0).
  [[nodiscard]] std::vector<std::string> glyphs(std::size_t cells, double min_span, bool unicode) const;

 private:
  std::deque<std::optional<double>> values_;
  long second_ = 0;  ///< second on the time axis to which the newest value belongs
};

/// The trends of the quantities of one channel.
struct ChannelTrends {
  Trend pressure_kpa;
  Trend displacement_mm;
};

/// The parts of a status as lines of text. A screen can show the parts in any arrangement. A missing value is
/// shown as "-".
struct StatusParts {
  std::vector<std::string> head;  ///< lines about state, sequence, pressurised fingers and fault
  std::vector<std::vector<std::string>> channels;
  std::vector<std::string> board;  ///< lines about the connection to the board and the attempts to restore
                                   ///< this connection
  std::vector<std::string> internals;  ///< lines about the state of the control loop and of the recording
};
/// Formats the parts of a status. If `trends` contains one element per channel, trends are shown in place of
/// bars.
[[nodiscard]] StatusParts parts_of(const nlohmann::ordered_json& status, const ViewStyle& style,
                                   const std::vector<ChannelTrends>* trends = nullptr);

/// Returns the lines of all parts in one list.
[[nodiscard]] std::vector<std::string> view_of(const nlohmann::ordered_json& status, const ViewStyle& style);

/// Returns the status as one line, for logs and pipes.
[[nodiscard]] std::string line_of_status(const nlohmann::ordered_json& status);

/// Returns one line per sequence, followed by one line per parameter with name, range, unit, default and
/// description. If a sequence cannot be started, its line states the reason.
[[nodiscard]] std::vector<std::string> view_of_sequences(const nlohmann::ordered_json& sequences);

/// Returns the names of the sequences in a reply of the daemon.
[[nodiscard]] std::vector<std::string> names_of_sequences(const nlohmann::ordered_json& sequences);

/// Formats an event of the socket API as "   12.340 s  warning  left: Grip result: NO PART.". If the event
/// has a time of day, the line begins with local time: "2026-11-21 09:32:05.123  warning  ...".
[[nodiscard]] std::string line_of_event(const nlohmann::ordered_json& event);

/// Formats the response to an acknowledgement: "acknowledged F202 reading_out_of_range of left; nothing moves
/// until the next start".
[[nodiscard]] std::string sentence_of_acknowledged(const nlohmann::ordered_json& result);

/// Returns the text of an event that states why a sequence failed: a finger was not at rest, or a fault
/// latched. Returns "" for every other event.
[[nodiscard]] std::string failure_reason(const nlohmann::ordered_json& event);

/// Formats an event for a narrow screen: "09:32:05 !  left: Grip result: NO PART.". `!` marks a warning and
/// `!!` an error.
[[nodiscard]] std::string brief_line_of_event(const nlohmann::ordered_json& event);

/// Name of the subfolder for the results of softgrip-health.service, in the folder of the recordings.
inline constexpr const char* health_folder = "health";
/// Age above which a result of `softgrip health` is out of date [s].
inline constexpr double health_old_s = 3 * 86400.0;

/// Returns the content of health.json from the subfolder `health`, with the added member `age_s`. Returns
/// null if the file cannot be read.
/// @param recordings  folder of the recordings; empty if there is none
[[nodiscard]] nlohmann::ordered_json last_health(const std::string& recordings);

/// One line of text about the health of the fingers. The complete list contains one line per changed finger,
/// or one line for all fingers together. If the result is out of date, one more line states this. The list is
/// empty if `health` is null.
struct HealthLine {
  std::string text;
  bool good = true;
  std::string advice;  ///< remedy for the alarm; empty if no remedy is needed
};
[[nodiscard]] std::vector<HealthLine> health_lines(const nlohmann::ordered_json& health);

}  // namespace softgrip::tools
