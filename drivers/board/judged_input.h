#pragma once
// Converts the raw number of an input to mm or kPa and determines its validity.

#include <cstdint>
#include <limits>
#include <optional>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"
#include "model/reading.h"

namespace softgrip::drivers {

/// An input after scaling. Both numbers are NaN if the board delivered no value at all.
struct JudgedInput {
  double electrical = std::numeric_limits<double>::quiet_NaN();  ///< V or mA
  double physical = std::numeric_limits<double>::quiet_NaN();    ///< mm or kPa
  model::Validity validity = model::Validity::none_yet;
};

/// Determines the value and validity of one input. The board's error codes have priority over all other
/// checks, and the sensor's error codes over the electrical range, because sensors place their codes outside
/// the range. If the sensor reports no error and the map has a status register, a `status` that is not ok
/// replaces the result of the range check.
[[nodiscard]] JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                                std::optional<std::uint16_t> status) noexcept;

/// Determines the value and validity of an input in V or mA for which the board reports no error.
[[nodiscard]] JudgedInput judge(const InputWiring& wiring, double electrical) noexcept;

}  // namespace softgrip::drivers
