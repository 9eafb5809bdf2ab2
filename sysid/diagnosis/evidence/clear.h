#pragma once
// Defines when an effect is significant, for every sentence, table and figure.

namespace softgrip::sysid {

/// Returns true if an effect is large enough to be drawn and described. Its p-value must be below 0.02, and
/// it must explain at least 5 % of the unexplained error. For effects that are tested together, pass the
/// adjusted p-value. The limit is stricter than the intended 5 %: in short logs with a long correlation time,
/// the blocks are too short and the tests reject too often.
[[nodiscard]] constexpr bool is_clear(double p_value, double share_percent) {
  constexpr double once_in_fifty = 0.02;
  constexpr double a_twentieth_percent = 5;
  return p_value < once_in_fifty && share_percent >= a_twentieth_percent;
}

}  // namespace softgrip::sysid
