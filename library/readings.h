#pragma once
// Converts the readings of the public interface to those of the drivers, and back.

#include "library/include/softgrip/board.h"
#include "model/reading.h"

namespace softgrip::library {

[[nodiscard]] Validity validity_of(model::Validity validity) noexcept;
[[nodiscard]] model::Reading reading_of(const Reading& reading) noexcept;
[[nodiscard]] Reading reading_of(const model::Reading& reading) noexcept;

}  // namespace softgrip::library
