#pragma once
// Converts the public limits to the limits of control/.

#include "control/elements/limits.h"
#include "library/include/softgrip/control.h"

namespace softgrip::library {

[[nodiscard]] control::LimitSettings settings_of(const Limits& limits) noexcept;
/// Checks and converts limits. Throws InvalidArgument.
control::LimitSettings checked(const Limits& limits);

}  // namespace softgrip::library
