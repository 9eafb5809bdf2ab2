#pragma once
// Converts the raw number of an input to mm or kPa, and determines if the reading is valid.

#include <cstdint>
#include <limits>
#include <optional>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"
#include "model/reading.h"

namespace softgrip::drivers {

/// An input after scaling. Both numbers are NaN if the board delivered no number.
struct JudgedInput {
  double electrical = std::numeric_limits<double>::quiet_NaN();  ///< electrical value of the input [V or mA]
  double physical = std::numeric_limits<double>::quiet_NaN();    ///< value of the input after scaling [mm or
                                                                 ///< kPa]
  model::Validity validity = model::Validity::none_yet;
};

/// Determines the value and the validity of one input. The board's error codes have priority over all other
/// checks. The sensor's error codes have priority over the electrical range, because sensors place their
/// codes outside the range. If the sensor reports no error and the map has a status register, a `status` that
/// is not ok replaces the result of the range check.
[[nodiscard]] JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                                std::optional<std::uint16_t> status) noexcept;

/// Determines the value and the validity of an input in V or mA. The board must have reported no error for
/// this input.
[[nodiscard]] JudgedInput judge(const InputWiring& wiring, double electrical) noexcept;

}  // namespace softgrip::drivers
