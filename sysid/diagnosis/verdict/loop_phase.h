#pragma once
// Detects valve stiction in a closed loop.
//
// In a closed loop, the command depends on the readings and their noise. A simulation from the command
// therefore gives no evidence about the valve. Only the comparison of predictions in loop_valve.h can show
// that the valve sticks. The correlation of command and reading determines which other explanations must be
// compared with a sticking valve:
// - If command and reading rise together, hysteresis of the finger has a similar effect as a sticking valve.
//   Then the hysteresis of the model is compared, too. If they do not rise together, the controller acts
//   against a disturbance, and a fit of the model to this record is meaningless.
// - If, in addition, the cross-correlation is even (phase shift of 0 degrees), the reading follows the
//   command without a visible delay. Then a curved characteristic is compared, too. A curved
//   characteristic does not shift the phase. A sticking valve in a process that settles shifts it by 90
//   degrees: A. Horch, "A simple method for detection of stiction in control valves", Control Engineering
//   Practice 7 (1999) 1221-1231.

#include <optional>
#include <vector>

#include "sysid/diagnosis/verdict/loop_valve.h"

namespace softgrip::sysid {

/// Returns a measure of symmetry of the cross-correlation: 1 if it is odd, 0 if it is even. The measure is
/// |left - right| / (left + right). `left` and `right` are the distances from lag 0 to the nearest zero
/// crossing on each side. Returns nullopt if one side has no zero crossing or if one of the series is
/// constant.
[[nodiscard]] std::optional<double> phase_ratio(const std::vector<double>& command,
                                                const std::vector<double>& reading);

/// Returns the sticking valve that the signals show, or nullopt. Two conditions must hold: the loop is
/// closed, and a sticking valve predicts the readings better than the other explanations (see above). The
/// required likelihood ratio is exp(limits::strict_log_likelihood), multiplied by the number of sticking
/// valves that are compared.
/// @param response  readings that the model predicts from the command, or empty. It has the length of
/// `command` and `reading`. Samples with a NaN in one of the series are skipped.
[[nodiscard]] std::optional<StickingStem> shown_stiction(const std::vector<double>& command,
                                                         const std::vector<double>& reading,
                                                         const std::vector<double>& response = {});

}  // namespace softgrip::sysid
