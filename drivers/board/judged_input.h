#pragma once
// From the raw number of an input to millimetres or kilopascals, and whether they can be believed.

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

/// Judges one input. An error code is named before a range, since sensors place their codes outside it:
/// first the board's error codes and status register (`status`, if the map has one), then the sensor's
/// error codes, then the electrical range.
[[nodiscard]] JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                                std::optional<std::uint16_t> status) noexcept;

/// Judges a value in V or mA that the board itself holds to be good.
[[nodiscard]] JudgedInput judge(const InputWiring& wiring, double electrical) noexcept;

}  // namespace softgrip::drivers
