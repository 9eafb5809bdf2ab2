#pragma once
// Fits an effect to later readings. The parameters of the baseline model stay constant.

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

/// Returns the penalty for the parameters of an effect, as a sum of whitened squares.
[[nodiscard]] double price_of(const Effect& effect);

/// Fits the parameters of an effect. The fit is continued from the best start points
/// (limits::followed_starts), and the best result is returned. The other effects stay constant.
/// @param without  whitened residual with the other effects only: result of readings.white(others).
[[nodiscard]] EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                                   const std::vector<FittedEffect>& others, const Eigen::VectorXd& without);

/// Returns the step of a parameter for its numerical derivative. The step is a small share of the parameter
/// value or of its typical value, and it stays within the bounds of the parameter.
[[nodiscard]] double small_move(const FittedEffect& fitted, std::size_t number);

}  // namespace softgrip::sysid
