#pragma once
// Detects valve stiction in a closed loop without a simulation.
//
// In a closed loop the command depends on the readings and their noise, so a simulation from the command
// gives no evidence about the valve. The phase between command and reading does give evidence. If the valve
// sticks, the cross-correlation is odd (a shift of 90 degrees). If a disturbance or a tightly tuned
// controller causes the oscillation, the cross-correlation is even (180 degrees). This rule holds for
// self-regulating processes. A. Horch, "A simple method for detection of stiction in control valves", Control
// Engineering Practice 7 (1999) 1221-1231.

#include <optional>
#include <vector>

namespace softgrip::sysid {

/// Returns true if a command can be predicted better from its own past and past readings than from its own
/// past alone (Granger's test for three samples of each, at limits::feedback_probability). Readings do not
/// improve the prediction of a command that was planned before the run.
/// @param command, reading  series of equal length. Pairs with a NaN are skipped. With fewer than 50 pairs,
/// the result is false.
[[nodiscard]] bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading);

/// Returns 1 for an odd cross-correlation and 0 for an even one: |left - right| / (left + right), where left
/// and right are the distances of the zero crossings next to lag 0. Returns nullopt if one side has no zero
/// crossing or if a series is constant.
[[nodiscard]] std::optional<double> phase_ratio(const std::vector<double>& command,
                                                const std::vector<double>& reading);

/// Returns true if the loop is closed and its phase lies within 30 degrees of 90 degrees, which indicates a
/// sticking valve.
/// valve.
[[nodiscard]] bool shows_stiction(const std::vector<double>& command, const std::vector<double>& reading);

}  // namespace softgrip::sysid
