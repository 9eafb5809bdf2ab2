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
  valve,             ///< command to pressure: nonlinearity, direction, saturation and supply
  finger,            ///< pressure to displacement: nonlinearity and plays
  valve_and_finger,  ///< command to displacement: the terms of both
};

/// Time constants of the filters of a finger [s]. The last four are slower than most motions: they also
/// describe the transient after the start of a log.
inline constexpr std::array finger_lags_s{0.02, 0.06, 0.2, 0.6, 2.0, 6.0, 20.0, 60.0};
inline constexpr std::size_t slow_lags = 4;

/// Returns one row per sample and one column per weight, scaled to the size of the drive [kPa]. The number of
/// columns is equal for all records: columns of a supply that is not recorded are 0.
/// @param drive_kpa  replaces the drive of the record; of equal length.
/// @param largest_kpa  scale of the nonlinear columns.
[[nodiscard]] Eigen::MatrixXd filter_columns(const Record& record, const std::vector<double>& drive_kpa,
                                             FilterKind kind, double largest_kpa);

/// Returns filter_columns() times `weights`. It uses one filter per time constant instead of one per column.
[[nodiscard]] Eigen::VectorXd weighted_filters(const Record& record, const std::vector<double>& drive_kpa,
                                               FilterKind kind, double largest_kpa,
                                               const Eigen::VectorXd& weights);

/// Returns the output of a first-order lag. The signal is linear between samples and settled at its first
/// value. A time constant of 0 is no lag.
[[nodiscard]] std::vector<double> lagged(const Record& record, const std::vector<double>& signal,
                                         double time_constant_s);

}  // namespace softgrip::sysid
