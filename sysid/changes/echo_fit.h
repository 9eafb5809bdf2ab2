#pragma once
// What an echo explains of the readings that models leave, judged on blocks that are held out in turn.

#include <vector>

#include <Eigen/Core>

#include "sysid/changes/bins.h"
#include "sysid/changes/echo.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// An echo with the weights of the best ridge.
struct FittedEcho {
  Eigen::VectorXd weights;  ///< by the columns of echo_columns()
  Binned left;              ///< what model and echo leave while held out; NaN without reading
  double left_mm = 0;       ///< root of its mean square
};

/// One echo for each model: all follow the records' drives, so that columns and factors are theirs together.
/// @param left  by model and record: what the model leaves, in bins of bin_s.
/// @param largest_kpa  of all records.
[[nodiscard]] std::vector<FittedEcho> fit_echo(const std::vector<Record>& records, EchoKind kind,
                                               double bin_s, double largest_kpa,
                                               const std::vector<Binned>& left);

}  // namespace softgrip::sysid
