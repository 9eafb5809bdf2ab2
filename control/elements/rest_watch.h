#pragma once
// Has a finger come to rest? Its readings stay within a band for a time.

#include <algorithm>

#include "control/elements/grip_detector.h"

namespace softgrip::control {

class RestWatch {
 public:
  RestWatch(double band_mm, double time_s) noexcept : band_mm_(band_mm), time_s_(time_s) {}

  void start() noexcept { any_ = false; }

  /// True from the tick on in which the finger has been at rest for long enough. A channel without sight is
  /// at rest when its command has not been changed for that time.
  bool observe(double time_s, const ChannelView& view) noexcept {
    const double value = view.sighted ? view.displacement_mm : view.command_kpa;
    if (view.sighted && !view.valid) {
      any_ = false;
      return false;
    }
    const double band = view.sighted ? band_mm_ : 0;
    lowest_ = any_ ? std::min(lowest_, value) : value;
    highest_ = any_ ? std::max(highest_, value) : value;
    if (!any_ || highest_ - lowest_ > band) {
      any_ = true;
      lowest_ = highest_ = value;
      since_s_ = time_s;
    }
    return time_s - since_s_ >= time_s_;
  }

 private:
  double band_mm_;
  double time_s_;
  double lowest_ = 0;
  double highest_ = 0;
  double since_s_ = 0;
  bool any_ = false;
};

}  // namespace softgrip::control
