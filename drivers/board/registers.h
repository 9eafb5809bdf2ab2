#pragma once
// Converts raw numbers to registers and back, for the Modbus board and the emulator.

#include <cstdint>
#include <span>

#include "drivers/board/board_map.h"

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

}  // namespace softgrip::drivers
