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

/// Returns true if past readings improve the prediction of the command from its own past values. The function
/// applies Granger's test with three past samples of each series at the level limits::strict_probability. The
/// result is false for a command whose noise is below limits::planned_roughness, because such a command was
/// planned before the run.
/// @param command, reading  series of equal length. Samples with a NaN in one of the series are skipped. With
/// fewer than 53 remaining samples, the result is false.
[[nodiscard]] bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading);

/// Returns a measure of symmetry of the cross-correlation: 1 if it is odd, 0 if it is even. The measure is
/// |left - right| / (left + right). `left` and `right` are the distances from lag 0 to the nearest zero
/// crossing on each side. Returns nullopt if one side has no zero crossing or if one of the series is
/// constant.
[[nodiscard]] std::optional<double> phase_ratio(const std::vector<double>& command,
                                                const std::vector<double>& reading);

/// Returns true if the signals indicate a sticking valve. Two conditions must hold: the loop is closed, and
/// the phase shift between command and reading is between 60 and 120 degrees.
[[nodiscard]] bool shows_stiction(const std::vector<double>& command, const std::vector<double>& reading);

}  // namespace softgrip::sysid
