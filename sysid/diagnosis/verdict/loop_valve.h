#pragma once
// Tests if the valve of a control loop sticks, by comparing two predictions of the readings.
//
// The phase between command and reading depends on the controller: an integrating controller shifts the phase
// by 90 degrees for every slow oscillation, also if a disturbance causes it. The phase alone therefore cannot
// show that the valve sticks. This test compares two models of the loop (Hammerstein model with a sticking
// valve: M. Jelali, "Estimation of valve stiction in control loops using separable least-squares and global
// search algorithms", Journal of Process Control 18 (2008) 632-642). In the first model, the stem of the
// valve follows the command. In the second model, the stem sticks. In both models, the reading is the sum of
// the stem position behind a dead time and a first-order lag, and of a load. The load is an integrated
// autoregressive moving-average process, so the one-step predictions are consistent in a closed loop, too
// (L. Ljung, "System Identification", 2nd edition, 1999). The prediction of a reading uses no command of the
// same sample, because this command may depend on the reading. Other explanations of the readings can be
// compared in addition: a curved characteristic, and the hysteresis of a model.

#include <optional>
#include <vector>

namespace softgrip::sysid {

/// Positions of a valve stem.
/// @param band  change of the command after a reversal at which the stem begins to move (deadband plus stick
/// band, S); @param jump  jump of the stem at this moment (slip jump, J), at most `band`
/// Model: Q.P. He, J. Wang, M. Pottmann, S.J. Qin, "A curve fitting method for detecting valve stiction in
/// oscillating control loops", Industrial & Engineering Chemistry Research 46 (2007) 4549-4560.
[[nodiscard]] std::vector<double> stem_positions(const std::vector<double>& command, double band,
                                                 double jump);

/// Explanations of the readings without a sticking valve, in addition to a reading that follows the command.
struct OtherExplanations {
  bool curved = false;  ///< the reading is a quadratic function of the delayed and lagged command
  /// Response of a model to the command, or empty. One value per reading. Like the command, it predicts only
  /// later readings.
  std::vector<double> response;
};

/// The best sticking valve, compared with the best explanation without a sticking valve.
struct StickingStem {
  double band = 0;  ///< S, in the unit of the command
  double jump = 0;  ///< J, in the unit of the command
  /// Natural logarithm of the likelihood ratio, minus the natural logarithm of the number of sticking valves
  /// in the grid of bands and jumps. The correction limits the probability that one of many sticking valves
  /// fits by chance (Bonferroni). The best two sticking valves of the grid are refined.
  double log_likelihood_ratio = 0;
};

/// Returns the sticking valve that predicts the readings best. The band of each sticking valve exceeds the
/// noise of the command, because a smaller band acts on the noise like a filter. The band is at least 20 % of
/// the range of the command, because the command of a loop that oscillates because of its valve moves by
/// little more than the band. The gain from command to reading must not be negative. Returns nullopt if
/// - more than half of the commands or of the readings repeat the previous value, because the record was then
///   compressed, and a compressed record looks like rests of the valve (N.F. Thornhill et al., "The impact of
///   compression on data-driven process analyses", Journal of Process Control 14 (2004) 389-398);
/// - no band is possible, or the series are too short.
/// @param command, reading  series of equal length without NaN
[[nodiscard]] std::optional<StickingStem> best_sticking_stem(const std::vector<double>& command,
                                                             const std::vector<double>& reading,
                                                             const OtherExplanations& others = {});

}  // namespace softgrip::sysid
