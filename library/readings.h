#pragma once
// Converts readings between the types of the public interface and the types of the drivers.

#include "library/include/softgrip/board.h"
#include "model/reading.h"

namespace softgrip::library {

[[nodiscard]] Validity validity_of(model::Validity validity) noexcept;
[[nodiscard]] model::Reading reading_of(const Reading& reading) noexcept;
[[nodiscard]] Reading reading_of(const model::Reading& reading) noexcept;

}  // namespace softgrip::library
