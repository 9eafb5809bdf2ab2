#pragma once
// Prepares the signals of a control loop, and detects that a log was recorded in a closed loop.

#include <vector>

#include <Eigen/Core>

namespace softgrip::sysid {

/// Signals of a control loop, without gaps. `response` is empty, or contains the readings that a model
/// predicts.
struct LoopSeries {
  std::vector<double> command, reading, response;
};

/// Returns the samples in which all series are finite.
/// @param response  as long as the other series, or empty
[[nodiscard]] LoopSeries finite_samples(const std::vector<double>& command,
                                        const std::vector<double>& reading,
                                        const std::vector<double>& response = {});

/// Command and reading with zero mean and unit standard deviation.
struct ScaledPair {
  Eigen::VectorXd command, reading;
};

/// Returns the samples in which both series are finite. The result is empty if one of the series is constant.
[[nodiscard]] ScaledPair scaled_pair(const std::vector<double>& command, const std::vector<double>& reading);

/// Returns true if the command depends on the readings. One of two conditions must hold at the level
/// limits::strict_probability. Either past readings improve the prediction of the command from its own past
/// values (Granger's test with three past samples of each series). Or, with the same past samples, a higher
/// reading is related to a lower command of the same sample. The finger itself has the opposite effect,
/// because a higher pressure increases the reading. The result is false for a command whose noise is below
/// limits::planned_roughness, because such a command was planned before the run.
/// @param command, reading  series of equal length. Samples with a NaN in one of the series are skipped. With
/// fewer than 53 remaining samples, the result is false.
[[nodiscard]] bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading);

}  // namespace softgrip::sysid
