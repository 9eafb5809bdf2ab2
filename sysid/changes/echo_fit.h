#pragma once
// What an echo explains of the readings that models leave, judged on units that are left out in turn.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/bins.h"
#include "sysid/changes/echo.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/units.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// An echo with the weights of the best ridge.
struct FittedEcho {
  Eigen::VectorXd weights;  ///< by the columns of echo_columns(); none where the model alone predicts as well
  Binned left;              ///< what model and echo leave of each unit while it is left out; NaN: no reading
  double left_mm = 0;       ///< root of its mean square about the mean of each unit
};

/// Squares of two residuals over blocks of some seconds, each about its mean in every unit.
[[nodiscard]] PairedLosses losses_of(const Binned& worse, const Binned& better, const Units& units,
                                     double bin_s);

/// What a model leaves of all records, in bins: fitted without each unit in turn, and fitted to all.
using LeftByUnit = std::vector<Binned>;

/// One echo for each model: all follow the records' drives, so that columns and factors are theirs together.
/// A model that is not finite at some reading has an infinite left_mm.
/// @param left  by model. @param largest_kpa  of all records.
[[nodiscard]] std::vector<FittedEcho> fit_echo(const std::vector<Record>& records, const Units& units,
                                               EchoKind kind, double bin_s, double largest_kpa,
                                               const std::vector<LeftByUnit>& left, std::uint64_t seed);

}  // namespace softgrip::sysid
