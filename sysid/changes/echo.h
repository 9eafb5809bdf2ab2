#pragma once
// What a linear bank of first-order filters makes of a drive: columns for what a model leaves of a healthy
// finger, or for the whole way from a command to a measured pressure. Weighted, they foretell and explain
// nothing; they are there so that a change stands out against less.

#include <array>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

enum class EchoKind {
  valve,             ///< command to pressure: bends, directions, a stage that saturates, the supply
  finger,            ///< pressure to displacement: bends and plays
  valve_and_finger,  ///< command to displacement: what either of them may do
};

/// Time constants of the filters of a finger [s]. The last four are slower than most motions: they also
/// describe the transient after the start of a log.
inline constexpr std::array finger_lags_s{0.02, 0.06, 0.2, 0.6, 2.0, 6.0, 20.0, 60.0};
inline constexpr std::size_t slow_lags = 4;

/// One row per sample and one column per weight, all of the size of the drive [kPa]. As many for every
/// record: what a supply that is not recorded would tell is 0.
/// @param drive_kpa  in place of the record's own, as long. @param largest_kpa  what bends are scaled by.
[[nodiscard]] Eigen::MatrixXd echo_columns(const Record& record, const std::vector<double>& drive_kpa,
                                           EchoKind kind, double largest_kpa);

/// echo_columns() times `weights`, with one filter per time constant in place of one per column.
[[nodiscard]] Eigen::VectorXd weighted_echo(const Record& record, const std::vector<double>& drive_kpa,
                                            EchoKind kind, double largest_kpa,
                                            const Eigen::VectorXd& weights);

/// A first-order lag of a signal that is straight between samples; settled at its first value. A time
/// constant of 0 is no lag.
[[nodiscard]] std::vector<double> lagged(const Record& record, const std::vector<double>& signal,
                                         double time_constant_s);

}  // namespace softgrip::sysid
