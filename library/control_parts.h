#pragma once
// Converts the limits of the public interface to the limits of control/.
// Converts readings between the types of the public interface and the types of the drivers.

#include "control/elements/limits.h"
#include "library/include/softgrip/board.h"
#include "library/include/softgrip/control.h"
#include "model/reading.h"

namespace softgrip::library {

[[nodiscard]] control::LimitSettings settings_of(const Limits& limits) noexcept;
/// Checks limits and converts them. Throws InvalidArgument if a limit is invalid.
control::LimitSettings checked(const Limits& limits);

[[nodiscard]] Validity validity_of(model::Validity validity) noexcept;
[[nodiscard]] model::Reading reading_of(const Reading& reading) noexcept;
[[nodiscard]] Reading reading_of(const model::Reading& reading) noexcept;

}  // namespace softgrip::library
