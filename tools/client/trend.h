#pragma once
// Draws the recent course of a quantity as one line of characters.

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

  /// Adds a value. `time_s` normally never decreases. If it decreases, another daemon has started, and the
  /// trend begins again.
  void add(double time_s, std::optional<double> value);

  /// Returns at most `cells` characters, one per second, newest last. Each is one column wide. The scale
  /// covers the shown values. Its span is at least `least_span` (> 0).
  [[nodiscard]] std::vector<std::string> glyphs(std::size_t cells, double least_span, bool unicode) const;

 private:
  std::deque<std::optional<double>> values_;
  long second_ = 0;  ///< second of the newest value
};

/// The trends of one channel.
struct ChannelTrends {
  Trend pressure_kpa;
  Trend displacement_mm;
};

}  // namespace softgrip::tools
