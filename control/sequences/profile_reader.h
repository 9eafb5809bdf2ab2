#pragma once
// Reads the profile of a pressure step: a test signal, or points between which the pressure is linear.
// Defines the ranges of the numbers in the steps of a sequence file.

#include "control/tick/sequence.h"
#include "document/reader.h"

namespace softgrip::control {

namespace step_ranges {

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

}  // namespace step_ranges

/// Reads the keys `signal`, `scale`, `points` and `cycles` of a pressure step. Adds all errors to `problems`.
/// @param document  document that contains the pressure step.
void read_profile(document::MapReader& map, const document::Document& document, document::Problems& problems,
                  Profile& profile);

}  // namespace softgrip::control
