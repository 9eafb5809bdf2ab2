#pragma once
// Searches the PID gains with the lowest cost. All controllers in a comparison are tuned by this search.
// Therefore, differences between their results come from their structure and not from the method of tuning.

#include <array>
#include <functional>

#include "control/elements/pid.h"

namespace softgrip::control {

/// The variables of the search: ln kp, ln ki and a third variable for the derivative. The caller defines the
/// meaning of the third variable.
using GainPoint = std::array<double, 3>;

/// Settings of the simplex method of Nelder and Mead (Computer Journal 7, 1965).
struct Simplex {
  GainPoint edges{0.4, 0.4, 0.02};  ///< distances of the corners of the simplex from the start point of the
                                    ///< search, one distance per variable
  int iterations = 60;    ///< number of iterations of the search; an iteration computes the cost 1, 2 or 5
                          ///< times
  double done_share = 0;  ///< the search ends when the costs of the corners differ by less than this share of
                          ///< the lowest cost; 0: the number of iterations alone ends the search
};
/// Returns the corner of the simplex that has the lowest cost at the end of the search.
[[nodiscard]] GainPoint nelder_mead(const std::function<double(const GainPoint&)>& cost,
                                    const GainPoint& start, double cost_at_start, const Simplex& simplex);

struct GainSearch {
  int iterations = 60;  ///< number of iterations of the simplex search after the grid search
  /// Step through the list of grid points (5 values of kp, 6 values of ki). With the step n, only every n-th
  /// point is used; with 1, all points are used.
  int coarseness = 1;
};

/// Returns the gains with the smallest `cost`. A coarse grid search in kp and ki comes first. The simplex
/// search in ln kp, ln ki and kd starts from the best grid point. All other PID settings keep their defaults.
[[nodiscard]] PidSettings search_gains(const std::function<double(const PidSettings&)>& cost,
                                       const GainSearch& search = {});

}  // namespace softgrip::control
