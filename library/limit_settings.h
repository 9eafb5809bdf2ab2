#pragma once
// Converts the limits of the public interface to the limits of control/.

#include "control/elements/limits.h"
#include "library/include/softgrip/control.h"

namespace softgrip::library {

[[nodiscard]] control::LimitSettings settings_of(const Limits& limits) noexcept;
/// Checks limits and converts them. Throws InvalidArgument if a limit is invalid.
control::LimitSettings checked(const Limits& limits);

}  // namespace softgrip::library
