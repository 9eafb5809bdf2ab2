#include "sysid/pages/chart_scale.h"

#include <algorithm>
#include <cmath>

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

}  // namespace softgrip::sysid
