#pragma once
// A bank of first-order filters of the input: regressors for the residual of a model of a healthy finger, or
// for the complete path from a command to a measured pressure. The weights have no physical meaning. They
// reduce the residual, so that smaller changes are significant.

#include <array>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

enum class FilterKind {
  valve,             ///< command to pressure: bends, directions, a stage that saturates, the supply
  finger,            ///< pressure to displacement: bends and plays
  valve_and_finger,  ///< command to displacement: what either of them may do
};

/// Time constants of the filters of a finger [s]. The last four are slower than most motions: they also
/// describe the transient after the start of a log.
inline constexpr std::array finger_lags_s{0.02, 0.06, 0.2, 0.6, 2.0, 6.0, 20.0, 60.0};
inline constexpr std::size_t slow_lags = 4;

/// One row per sample and one column per weight, all of the size of the drive [kPa]. Their number is the
/// same for each record: columns of a supply that is not recorded are 0.
/// @param drive_kpa  in place of the record's own, as long. @param largest_kpa  scale of the nonlinear
/// columns.
[[nodiscard]] Eigen::MatrixXd filter_columns(const Record& record, const std::vector<double>& drive_kpa,
                                             FilterKind kind, double largest_kpa);

/// filter_columns() times `weights`, with one filter per time constant in place of one per column.
[[nodiscard]] Eigen::VectorXd weighted_filters(const Record& record, const std::vector<double>& drive_kpa,
                                               FilterKind kind, double largest_kpa,
                                               const Eigen::VectorXd& weights);

/// A first-order lag of a signal that is straight between samples; settled at its first value. A time
/// constant of 0 is no lag.
[[nodiscard]] std::vector<double> lagged(const Record& record, const std::vector<double>& signal,
                                         double time_constant_s);

}  // namespace softgrip::sysid
