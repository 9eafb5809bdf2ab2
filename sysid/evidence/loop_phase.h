#pragma once
// Detects valve stiction in a closed loop from the phase between command and reading.
//
// In a closed loop, the command depends on the readings and their noise. A simulation from the command
// therefore gives no evidence about the valve, but the phase between command and reading does. If the valve
// sticks, the cross-correlation of command and reading is odd (phase shift of 90 degrees). If a disturbance
// or a tightly tuned controller causes the oscillation, the cross-correlation is even (180 degrees). This
// rule holds for self-regulating processes. A. Horch, "A simple method for detection of stiction in control
// valves", Control Engineering Practice 7 (1999) 1221-1231.

#include <optional>
#include <vector>

namespace softgrip::sysid {

/// Returns true if past readings improve the prediction of the command from its own past. This is Granger's
/// test with three samples of each series, at limits::strict_probability. Readings do not improve the
/// prediction of a command that was planned before the run.
/// @param command, reading  series of equal length. Pairs with a NaN are skipped. With fewer than 50 pairs,
/// the result is false.
[[nodiscard]] bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading);

/// Returns 1 for an odd cross-correlation and 0 for an even one. The result is |left - right| / (left +
/// right), where left and right are the distances from lag 0 to the next zero crossing on each side. Returns
/// nullopt if one side has no zero crossing or if one of the series is constant.
[[nodiscard]] std::optional<double> phase_ratio(const std::vector<double>& command,
                                                const std::vector<double>& reading);

/// Returns true if the loop is closed and the phase shift between command and reading is within 30 degrees of
/// 90 degrees. This indicates a sticking valve.
[[nodiscard]] bool shows_stiction(const std::vector<double>& command, const std::vector<double>& reading);

}  // namespace softgrip::sysid
