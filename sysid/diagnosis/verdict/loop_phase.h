#pragma once
// Detects valve stiction in a closed loop.
//
// In a closed loop, the command depends on the readings and their noise. A simulation from the command
// therefore gives no evidence about the valve. If the cross-correlation of command and reading is even and
// positive (phase shift of 0 degrees), the reading follows the command. Hysteresis of the finger then has the
// same effect as a sticking valve. If the valve sticks, the cross-correlation is odd (90 degrees): A. Horch,
// "A simple method for detection of stiction in control valves", Control Engineering Practice 7 (1999)
// 1221-1231. This holds for processes that settle. If the process integrates, as the level of a tank does,
// the phase shift is near 180 degrees. A disturbance or a tightly tuned controller also causes a shift of 180
// degrees, and an integrating controller shifts the phase of slow disturbances by 90 degrees. The phase can
// therefore exclude a sticking valve, but only the comparison of predictions in loop_valve.h can show it.

#include <optional>
#include <vector>

#include "sysid/diagnosis/verdict/loop_valve.h"

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

/// Returns the sticking valve that the signals show, or nullopt. Three conditions must hold: the loop is
/// closed, the phase shift between command and reading is more than 30 degrees, and a sticking valve
/// predicts the readings better than a valve that follows the command. The required likelihood ratio is
/// exp(limits::strict_log_likelihood), multiplied by the number of sticking valves that are compared.
[[nodiscard]] std::optional<StickingStem> shown_stiction(const std::vector<double>& command,
                                                         const std::vector<double>& reading);

}  // namespace softgrip::sysid
