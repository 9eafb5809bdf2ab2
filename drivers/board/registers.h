#pragma once
// Codes raw numbers into registers and back, for the Modbus board and the emulator.

#include <cstdint>
#include <span>

#include "drivers/board/board_map.h"

namespace softgrip::drivers {

/// Returns the raw number in `words` (words_of(kind) of them). A float32 may be infinite or NaN.
[[nodiscard]] double decode(std::span<const std::uint16_t> words, RegisterKind kind,
                            WordOrder order) noexcept;

/// Writes `raw` into `words`. Whole kinds round to nearest and saturate at the limits of the kind; NaN
/// becomes 0.
void encode(double raw, RegisterKind kind, WordOrder order, std::span<std::uint16_t> words) noexcept;

/// Returns the raw number of the terminal's converter for V or mA: scaled, limited to [raw_min, raw_max],
/// quantised to `bits`, and rounded for whole kinds. Emulated inputs use it.
[[nodiscard]] double quantised_raw(const TerminalBlock& terminals, double electrical) noexcept;

}  // namespace softgrip::drivers
