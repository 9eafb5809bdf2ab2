#pragma once
// How a quantity went lately, in one line of characters.

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace softgrip::tools {

/// The newest value of each second, the last `seconds_kept` of them. A second without one is a gap.
class Trend {
 public:
  static constexpr std::size_t seconds_kept = 300;

  /// `time_s` never falls; one that does (another daemon) begins anew.
  void add(double time_s, std::optional<double> value);

  /// At most `cells` characters, one per second, the newest last; each is one column wide. From the lowest to
  /// the highest that is shown, or over `least_span` (> 0) where that is more.
  [[nodiscard]] std::vector<std::string> glyphs(std::size_t cells, double least_span, bool unicode) const;

 private:
  std::deque<std::optional<double>> values_;
  long second_ = 0;  ///< of the newest value
};

/// The trends of one channel.
struct ChannelTrends {
  Trend pressure_kpa;
  Trend displacement_mm;
};

}  // namespace softgrip::tools
