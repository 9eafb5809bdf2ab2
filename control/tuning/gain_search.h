#pragma once
// Searches PID gains. All controllers are tuned by this search, so that a comparison of controllers shows the
// effect of their other parts.

#include <array>
#include <functional>

#include "control/elements/pid.h"

namespace softgrip::control {

/// The variables of the search: ln kp, ln ki and a third variable for the derivative. The caller defines the
/// meaning of the third variable.
using GainPoint = std::array<double, 3>;

/// Settings of the simplex method of Nelder and Mead (Computer Journal 7, 1965).
struct Simplex {
  GainPoint edges{0.4, 0.4, 0.02};  ///< distances from the start point of the search to the other corners of
                                    ///< the simplex
  int iterations = 60;              ///< number of iterations; each iteration computes the cost once or twice
  double done_share = 0;            ///< the search ends when the costs of the corners differ by less than
                                    ///< this share
};
/// Returns the corner of the simplex that has the lowest cost at the end of the search.
[[nodiscard]] GainPoint nelder_mead(const std::function<double(const GainPoint&)>& cost,
                                    const GainPoint& start, double cost_at_start, const Simplex& simplex);

struct GainSearch {
  int iterations = 60;  ///< number of iterations of the simplex search after the grid search
  /// Step through the points of the grid of 5 values of kp and 6 values of ki; 1 uses all points.
  int coarseness = 1;
};

/// Returns the gains with the smallest `cost`. A coarse grid search in kp and ki is followed by the simplex
/// search in ln kp, ln ki and kd. All other settings keep their defaults.
[[nodiscard]] PidSettings search_gains(const std::function<double(const PidSettings&)>& cost,
                                       const GainSearch& search = {});

}  // namespace softgrip::control
