#pragma once
// Numbers in registers: the coding of raw numbers, shared by the Modbus board and the emulator.

#include <cstdint>
#include <span>

#include "drivers/board/board_map.h"

namespace softgrip::drivers {

/// The raw number in `words` (words_of(kind) of them). A float32 may be infinite or NaN.
[[nodiscard]] double decode(std::span<const std::uint16_t> words, RegisterKind kind,
                            WordOrder order) noexcept;

/// Writes `raw` into `words`: whole kinds round to nearest and saturate at the kind's ends, NaN becomes 0.
void encode(double raw, RegisterKind kind, WordOrder order, std::span<std::uint16_t> words) noexcept;

/// The raw number that the terminal's converter makes of V or mA: scaled, clamped to [raw_min, raw_max],
/// quantised to `bits` and to whole numbers for whole kinds. What an emulated input shows.
[[nodiscard]] double quantised_raw(const TerminalBlock& terminals, double electrical) noexcept;

}  // namespace softgrip::drivers
