#pragma once
// Ranges of the numbers in the steps of a sequence file.

#include "document/reader.h"

namespace softgrip::control::step_ranges {

// Ranges that no rig of soft fingers exceeds. A rig has narrower limits, and prepare() checks a sequence
// against these limits.
inline constexpr document::Range displacement_mm{-100, 200};
inline constexpr document::Range pressure_kpa{-100, 1000};
inline constexpr document::Range squeeze_kpa{0.1, 1000};
inline constexpr document::Range speed{0.01, 1000};
inline constexpr document::Range short_time_s{0, 600};
inline constexpr document::Range long_time_s{0, 86400};
inline constexpr document::Range ramp_s{0.01, 600};
inline constexpr document::Range window_s{0.02, 60};

}  // namespace softgrip::control::step_ranges
