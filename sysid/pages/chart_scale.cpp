#include "sysid/pages/chart_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

double step_for(double width, int most) {
  const double rough = width / std::max(1, most);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-12)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

Scale::Scale(const Axis& axis, double lowest, double highest, double from_px, double to_px, bool with_margin)
    : axis_(axis), lower_(lowest), upper_(highest), from_px_(from_px), to_px_(to_px) {
  if (!(lower_ <= upper_)) {
    lower_ = axis.logarithmic ? 1 : 0;
    upper_ = axis.logarithmic ? 10 : 1;
  }
  if (!axis.categories.empty()) {
    lower_ = -0.5;
    upper_ = static_cast<double>(axis.categories.size()) - 0.5;
  } else if (lower_ == upper_) {
    const double half = axis.logarithmic ? 0 : std::max(0.5, 0.05 * std::abs(lower_));
    lower_ -= half;
    upper_ += half;
    if (axis.logarithmic) upper_ *= 10;
  } else if (with_margin && axis.logarithmic) {
    const double ratio = std::pow(upper_ / lower_, 0.04);
    lower_ /= ratio;
    upper_ *= ratio;
  } else if (with_margin) {
    const double margin = 0.04 * (upper_ - lower_);
    lower_ -= margin;
    upper_ += margin;
  }
  if (axis.lower) lower_ = *axis.lower;
  if (axis.upper) upper_ = *axis.upper;
  if (!(upper_ > lower_)) upper_ = lower_ + (axis.logarithmic ? 9 * lower_ : 1);
}

double Scale::px(double value) const {
  const double share = axis_.logarithmic ? std::log(value / lower_) / std::log(upper_ / lower_)
                                         : (value - lower_) / (upper_ - lower_);
  return from_px_ + std::clamp(share, -10.0, 11.0) * (to_px_ - from_px_);
}

std::vector<Tick> Scale::ticks(int most) const {
  std::vector<Tick> ticks;
  if (!axis_.categories.empty()) {
    for (std::size_t i = 0; i < axis_.categories.size(); ++i) {
      ticks.push_back({static_cast<double>(i), axis_.categories[i]});
    }
    return ticks;
  }
  if (axis_.logarithmic) {
    const bool few = std::log10(upper_ / lower_) < 2;
    const int last = static_cast<int>(std::floor(std::log10(upper_)));
    for (int exponent = static_cast<int>(std::floor(std::log10(lower_))); exponent <= last; ++exponent) {
      const double power = std::pow(10.0, exponent);
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double at = factor * power;
        if ((factor == 1 || few) && at >= lower_ && at <= upper_) ticks.push_back({at, significant(at, 3)});
      }
    }
    return ticks;
  }
  double step = step_for(upper_ - lower_, most);
  // A reader needs at least two ticks to read values from an axis.
  while (std::floor(upper_ / step) - std::ceil(lower_ / step) < 1) step = step_for(step / 2.5, 1);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const bool plain = decimals <= 6 && std::max(std::abs(lower_), std::abs(upper_)) < 1e7;
  for (double k = std::ceil(lower_ / step - 1e-9); k * step <= upper_ + 1e-9 * step; ++k) {
    ticks.push_back({k * step, plain ? fixed(k * step, decimals) : significant(k * step, 3)});
  }
  return ticks;
}

std::string in_words(std::string_view label) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 18> units{{
      {"s", "seconds"},
      {"mm", "millimetres"},
      {"kPa", "kilopascals"},
      {"kPa/s", "kilopascals per second"},
      {"mm/s", "millimetres per second"},
      {"mm/kPa", "millimetres per kilopascal"},
      {"deg", "degrees"},
      {"deg/s", "degrees per second"},
      {"deg/kPa", "degrees per kilopascal"},
      {"deg\xc2\xb2", "square degrees"},
      {"deg\xc2\xb2/Hz", "square degrees per hertz"},
      {"Hz", "hertz"},
      {"mm\xc2\xb2", "square millimetres"},
      {"mm\xc2\xb2/Hz", "square millimetres per hertz"},
      {"\xc2\xb0"
       "C",
       "degrees Celsius"},
      {"C", "degrees Celsius"},
      {"min", "minutes"},
      {"%", "per cent"},
  }};
  const std::size_t open = label.rfind('[');
  const bool alone = open == 0;
  if (open == std::string_view::npos || !label.ends_with(']') || (!alone && label[open - 1] != ' '))
    return std::string(label);
  const std::string_view unit = label.substr(open + 1, label.size() - open - 2);
  for (const auto& [sign, words] : units) {
    if (unit == sign)
      return alone ? std::string(words)
                   : std::string(label.substr(0, open - 1)) + " in " + std::string(words);
  }
  return std::string(label);
}

}  // namespace softgrip::sysid
