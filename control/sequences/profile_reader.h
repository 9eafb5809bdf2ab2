#pragma once
// Reads the profile of a pressure step: a test signal, or points between which the pressure is linear.

#include "control/tick/sequence.h"
#include "document/reader.h"

namespace softgrip::control {

/// Reads the keys `signal`, `scale`, `points` and `cycles` of a pressure step. Adds all errors to `problems`.
/// @param document  document that contains the pressure step.
void read_profile(document::MapReader& map, const document::Document& document, document::Problems& problems,
                  Profile& profile);

}  // namespace softgrip::control
