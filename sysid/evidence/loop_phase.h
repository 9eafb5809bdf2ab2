#pragma once
// What a control loop shows of its valve without a simulation.
//
// In a closed loop the command depends on the readings, and on their noise. A simulation from the command
// then proves nothing of the valve. The phase between command and reading does: if the valve sticks, the
// cross- correlation of both is odd (a shift of 90 degrees); if a disturbance or a tight controller causes
// the oscillation, it is even (180 degrees). It holds for self-regulating processes. A. Horch, "A simple
// method for detection of stiction in control valves", Control Engineering Practice 7 (1999) 1221-1231.

#include <optional>
#include <vector>

namespace softgrip::sysid {

/// Whether past readings improve the prediction of a command from its own past (Granger's test for three
/// samples of each, at limits::feedback_probability). A command that was planned before the run does not
/// depend on them.
/// @param command, reading  equally long; pairs with a NaN are left out. Fewer than 50 pairs are no loop.
[[nodiscard]] bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading);

/// 1 for an odd cross-correlation, 0 for an even one: |left - right| / (left + right) of the zero crossings
/// next to lag 0. Nothing if it does not cross zero on both sides, or if a series is constant.
[[nodiscard]] std::optional<double> phase_ratio(const std::vector<double>& command,
                                                const std::vector<double>& reading);

/// Whether a closed loop shows a valve that sticks: the phase is nearer than 30 degrees to 90.
[[nodiscard]] bool shows_stiction(const std::vector<double>& command, const std::vector<double>& reading);

}  // namespace softgrip::sysid
