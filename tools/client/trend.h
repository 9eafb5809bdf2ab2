#pragma once
// Draws the recent values of a quantity as one line of characters.

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace softgrip::tools {

/// The newest value of each second, for the last `seconds_kept` seconds. A second without a value is a gap.
class Trend {
 public:
  static constexpr std::size_t seconds_kept = 300;

  /// Adds a value at the time `time_s`. If `time_s` is smaller than in the last call, another daemon has
  /// started, and the trend begins again.
  void add(double time_s, std::optional<double> value);

  /// Returns at most `cells` characters, one per second, the newest second last. Each character is one column
  /// wide. The scale covers the shown values, and its span is at least `least_span` (> 0).
  [[nodiscard]] std::vector<std::string> glyphs(std::size_t cells, double least_span, bool unicode) const;

 private:
  std::deque<std::optional<double>> values_;
  long second_ = 0;  ///< second on the time axis to which the newest value belongs
};

/// The trends of the quantities of one channel.
struct ChannelTrends {
  Trend pressure_kpa;
  Trend displacement_mm;
};

}  // namespace softgrip::tools
