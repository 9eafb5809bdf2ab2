#pragma once
// What a linear bank of first-order filters makes of a drive: columns for what a model leaves of a healthy
// finger, or for the whole way from a command to a measured pressure. Weighted, they foretell and explain
// nothing; they are there so that a change stands out against less.

#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

enum class EchoKind {
  valve,   ///< command to pressure: bends, directions, a stage that saturates, the supply
  finger,  ///< pressure to displacement: bends and plays
};

/// One row per sample and one column per weight, all of the size of the drive [kPa].
/// @param drive_kpa  in place of the record's own, as long. @param largest_kpa  what bends are scaled by.
[[nodiscard]] Eigen::MatrixXd echo_columns(const Record& record, const std::vector<double>& drive_kpa,
                                           EchoKind kind, double largest_kpa);

/// A first-order lag of a signal that is straight between samples; settled at its first value.
[[nodiscard]] std::vector<double> lagged(const Record& record, const std::vector<double>& signal,
                                         double time_constant_s);

}  // namespace softgrip::sysid
