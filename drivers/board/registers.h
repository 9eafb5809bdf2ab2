#pragma once
// Converts raw numbers to registers and back, for the Modbus board and the emulator.
// Converts the raw number of an input to mm, kPa or degrees C, and determines if the reading is valid.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"
#include "model/reading.h"

namespace softgrip::drivers {

/// Returns the raw number that the registers `words` contain. The number of registers must be words_of(kind).
/// A float32 may be infinite or NaN.
[[nodiscard]] double decode(std::span<const std::uint16_t> words, RegisterKind kind,
                            WordOrder order) noexcept;

/// Writes `raw` into the registers `words`. For integer kinds, `raw` is rounded to the nearest integer and
/// limited to the range of the kind. NaN is written as 0.
void encode(double raw, RegisterKind kind, WordOrder order, std::span<std::uint16_t> words) noexcept;

/// Returns the raw number into which the converter of a terminal converts a value in V or mA. The value is
/// scaled, limited to [raw_min, raw_max], quantised to `bits`, and rounded for integer kinds. The emulator
/// uses this function for its inputs.
[[nodiscard]] double quantised_raw(const TerminalBlock& terminals, double electrical) noexcept;

/// The value of an input after scaling. Both numbers are NaN if the board delivered no number or an error
/// code for the input.
struct JudgedInput {
  double electrical = std::numeric_limits<double>::quiet_NaN();  ///< electrical value of the input [V or mA]
  double physical = std::numeric_limits<double>::quiet_NaN();    ///< value of the input after scaling [mm,
                                                                 ///< kPa or degrees C]
  model::Validity validity = model::Validity::none_yet;
};

/// Determines the value and the validity of one input. An error code of the board has priority over all other
/// checks. An error code of the sensor has priority over the check of the electrical range, because sensors
/// place their error codes outside this range. If the sensor reports no error and the board map has a status
/// register, a `status` that is not ok replaces the result of the range check.
[[nodiscard]] JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                                std::optional<std::uint16_t> status) noexcept;

/// Determines the value and the validity of an input from its value in V or mA. The caller must ensure that
/// the board has reported no error for this input.
[[nodiscard]] JudgedInput judge(const InputWiring& wiring, double electrical) noexcept;

}  // namespace softgrip::drivers
