#pragma once
// Computes a bank of first-order filters of the input. The filtered signals are regressors for the residual
// of a model of the healthy finger. If the pressure is evaluated, they are regressors for the measured
// pressure itself. Their weights have no physical meaning. The fitted filters reduce the residual, so that
// smaller changes become significant.

#include <array>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

enum class FilterKind {
  valve,             ///< from command to pressure: terms for nonlinearity, direction, saturation and supply
  finger,            ///< from pressure to displacement: terms for nonlinearity and plays
  valve_and_finger,  ///< from command to displacement: the terms of `valve` and of `finger`
};

/// Time constants of the filters for a finger [s]. The four longest ones exceed the duration of most motions.
/// They also describe the transient after the start of a log.
inline constexpr std::array finger_lags_s{0.02, 0.06, 0.2, 0.6, 2.0, 6.0, 20.0, 60.0};
/// Time constants of the filters for a valve [s]. With the time constant 0, the output equals the input. This
/// filter is left out if the filter bank also represents the finger, because the finger adds a lag.
inline constexpr std::array valve_lags_s{0.0, 0.015, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0};
inline constexpr std::size_t slow_lags = 4;

/// Returns the filtered signals: one row per sample and one column per weight, in units of the drive [kPa].
/// All records have the same number of columns. If the supply pressure is not recorded, its columns are 0.
/// @param drive_kpa  input of the filters, one value per sample. It replaces the drive of the record.
/// @param largest_kpa  pressure that scales the nonlinear columns.
[[nodiscard]] Eigen::MatrixXd filter_columns(const Record& record, const std::vector<double>& drive_kpa,
                                             FilterKind kind, double largest_kpa);

/// Returns the columns of filter_columns(), each averaged over bins by binned(). The computation does not
/// store the columns themselves.
/// @param drive_kpa  finite values, as for filter_columns().
[[nodiscard]] Eigen::MatrixXd binned_filter_columns(const Record& record,
                                                    const std::vector<double>& drive_kpa, FilterKind kind,
                                                    double largest_kpa, double bin_s);

/// Returns the product of filter_columns() and `weights`. The computation needs one filter per time constant
/// instead of one filter per column.
[[nodiscard]] Eigen::VectorXd weighted_filters(const Record& record, const std::vector<double>& drive_kpa,
                                               FilterKind kind, double largest_kpa,
                                               const Eigen::VectorXd& weights);

/// Returns the output of a first-order lag. The input is linear between samples. Before the first sample, the
/// output equals the first input. If the time constant is 0, the output always equals the input.
[[nodiscard]] std::vector<double> lagged(const Record& record, const std::vector<double>& signal,
                                         double time_constant_s);

}  // namespace softgrip::sysid
