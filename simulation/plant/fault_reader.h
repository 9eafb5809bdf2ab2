#pragma once
// Declares the keys of the faults of a finger. The events of a rig file and the faults file of the emulator
// have the same keys with the same limits.

#include <string>

#include "document/schema.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Returns the key of a leak, which the line fault `leaking` requires.
[[nodiscard]] document::Key<LineFault> leak_key();
/// Returns the key with the name `name` for the size of an offset [mm], which the sensor fault `offset`
/// requires.
[[nodiscard]] document::Key<SensorFault> offset_key(std::string name);
/// Reads an object with the keys `position_mm` and `yielding`.
[[nodiscard]] PlantObject read_object(const document::Document& document, const document::Node& node,
                                      document::Problems& problems);

}  // namespace softgrip::simulation
