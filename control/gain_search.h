#pragma once
// PID gains by one and the same search, so that what is compared is what stands beside the PID.

#include <functional>

#include "control/pid.h"

namespace softgrip::control {

struct GainSearch {
  /// Of Nelder and Mead's simplex after the grid; each costs one or two evaluations.
  int iterations = 60;
  /// Every how many points of the grid's 5 x 6 in kp and ki: 1 is all.
  int coarseness = 1;
};

/// The gains with the smallest `cost`: a coarse grid of kp and ki, then Nelder and Mead (Computer Journal 7,
/// 1965) on ln kp, ln ki and kd from its best. Everything else of the settings keeps its default.
[[nodiscard]] PidSettings search_gains(const std::function<double(const PidSettings&)>& cost,
                                       const GainSearch& search = {});

}  // namespace softgrip::control
