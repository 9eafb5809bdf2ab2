#pragma once
// What counts as clear, in every sentence, table and figure.

namespace softgrip::sysid {

/// Whether an effect is drawn and worded. One rule for all: chance alone would show it less than once in
/// fifty, and it is worth a twentieth of the error's structure. What is looked at beside others comes
/// adjusted for that. Stricter than the 5 % that are aimed at: in short logs with a long memory the blocks
/// are fewer memories long than wanted, and the tests are a little too easily impressed.
[[nodiscard]] constexpr bool is_clear(double p_value, double share_percent) {
  constexpr double once_in_fifty = 0.02;
  constexpr double a_twentieth_percent = 5;
  return p_value < once_in_fifty && share_percent >= a_twentieth_percent;
}

}  // namespace softgrip::sysid
