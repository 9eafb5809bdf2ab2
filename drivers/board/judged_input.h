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

/// Determines the value and validity of one input. Error codes are checked before the range, because sensors
/// place their codes outside the range. The order is: the board's error codes and status register (`status`,
/// if the map has one), the sensor's error codes, the electrical range.
[[nodiscard]] JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                                std::optional<std::uint16_t> status) noexcept;

/// Determines the validity of a value in V or mA that the board reports as good.
[[nodiscard]] JudgedInput judge(const InputWiring& wiring, double electrical) noexcept;

}  // namespace softgrip::drivers
