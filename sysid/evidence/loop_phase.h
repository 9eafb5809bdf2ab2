#pragma once
// Detects valve stiction in a closed loop without a simulation.
//
// In a closed loop the command depends on the readings and on their noise. A simulation from the command
// therefore gives no evidence about the valve. The phase between command and reading gives evidence. If the
// valve sticks, the cross-correlation is odd (a shift of 90 degrees). If a disturbance or a tight controller
// causes the oscillation, it is even (180 degrees). This holds for self-regulating processes. A. Horch, "A
// simple method for detection of stiction in control valves", Control Engineering Practice 7 (1999)
// 1221-1231.

#include <optional>
#include <vector>

namespace softgrip::sysid {

/// Returns true if past readings improve the prediction of a command from its own past (Granger's test for
/// three samples of each, at limits::feedback_probability). They do not improve it for a command that was
/// planned before the run.
/// @param command, reading  of equal length. Pairs with a NaN are skipped; with fewer than 50 pairs the
/// result is false.
[[nodiscard]] bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading);

/// Returns 1 for an odd cross-correlation and 0 for an even one: |left - right| / (left + right), where left
/// and right are the distances of the zero crossings next to lag 0. Returns nullopt if one side has no zero
/// crossing or if a series is constant.
[[nodiscard]] std::optional<double> phase_ratio(const std::vector<double>& command,
                                                const std::vector<double>& reading);

/// Returns true if the loop is closed and its phase lies within 30 degrees of 90 degrees, as for a sticking
/// valve.
[[nodiscard]] bool shows_stiction(const std::vector<double>& command, const std::vector<double>& reading);

}  // namespace softgrip::sysid
