#pragma once
// Defines when an effect counts as significant. All sentences, tables and figures use this definition.

#include "sysid/limits/limits.h"

namespace softgrip::sysid {

/// Returns true if an effect is significant, so that it is drawn and described. Its p-value must be below
/// 0.02, and it must explain at least 5 % of the unexplained error. For effects that are tested together,
/// pass the adjusted p-value. The limit is stricter than the intended significance level of 5 %, because the
/// tests reject too often in short logs whose residual has a long correlation time.
[[nodiscard]] constexpr bool is_clear(double p_value, double share_percent) {
  constexpr double once_in_fifty = 0.02;
  return p_value < once_in_fifty && share_percent >= 100 * limits::form_error_share;
}

}  // namespace softgrip::sysid
