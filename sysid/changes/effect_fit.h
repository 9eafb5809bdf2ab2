#pragma once
// Fits an effect to later readings; the baseline model is constant.

#include <vector>

#include <Eigen/Core>

#include "sysid/changes/effects.h"
#include "sysid/changes/later_readings.h"

namespace softgrip::sysid {

struct EffectFit {
  FittedEffect fitted;
  double sum_of_squares = 0;
  Eigen::VectorXd white;
};

/// Fits the parameters of an effect, starting from the best of its start points. The other effects stay
/// constant.
/// @param without  result of readings.white(others).
[[nodiscard]] EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                                   const std::vector<FittedEffect>& others, const Eigen::VectorXd& without);

/// Returns the step of a parameter for its numerical derivative: a small share of its value or of its typical
/// value. The step stays within the bounds of the parameter.
[[nodiscard]] double small_move(const FittedEffect& fitted, std::size_t number);

}  // namespace softgrip::sysid
