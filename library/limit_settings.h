#pragma once
// The public limits as those of control.

#include "control/elements/limits.h"
#include "library/include/softgrip/control.h"

namespace softgrip::library {

[[nodiscard]] control::LimitSettings settings_of(const Limits& limits) noexcept;
/// Throws InvalidArgument.
control::LimitSettings checked(const Limits& limits);

}  // namespace softgrip::library
