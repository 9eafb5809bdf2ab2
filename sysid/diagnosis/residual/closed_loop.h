#pragma once
// Detects that a log was recorded in a closed loop.

#include <vector>

namespace softgrip::sysid {

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
