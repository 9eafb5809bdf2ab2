#include "tools/client/daemon_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace softgrip::tools {
namespace {

constexpr std::array<const char*, 8> blocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::array<const char*, 8> ascii{"_", ".", ",", "-", "~", "=", "*", "#"};

}  // namespace

void Trend::add(double time_s, std::optional<double> value) {
  const long second = std::lround(std::floor(time_s));
  if (values_.empty() || second < second_) {
    values_.clear();
    second_ = second - 1;
  }
  // The number of empty seconds after a long pause is limited to the number of seconds that a trend can show.
  const long gap = std::min<long>(second - second_, seconds_kept);
  for (long i = 0; i < gap; ++i) values_.emplace_back();
  while (values_.size() > seconds_kept) values_.pop_front();
  second_ = second;
  if (value) values_.back() = value;
}

std::vector<std::string> Trend::glyphs(std::size_t cells, double min_span, bool unicode) const {
  const std::size_t shown = std::min(cells, values_.size());
  const auto begin = values_.end() - static_cast<std::ptrdiff_t>(shown);
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (auto value = begin; value != values_.end(); ++value) {
    lowest = std::min(lowest, value->value_or(lowest));
    highest = std::max(highest, value->value_or(highest));
  }
  const double span = std::max(highest - lowest, min_span);
  const auto& levels = unicode ? blocks : ascii;
  std::vector<std::string> glyphs;
  for (auto value = begin; value != values_.end(); ++value) {
    const double share = *value ? (**value - lowest) / span : 0;
    const auto level = static_cast<std::size_t>(share * static_cast<double>(levels.size()));
    glyphs.emplace_back(*value ? levels[std::min(level, levels.size() - 1)] : " ");
  }
  return glyphs;
}

}  // namespace softgrip::tools
