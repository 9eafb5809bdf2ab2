#pragma once
// Reads the faults of a finger from YAML. The keys and their limits are the same in the events of a rig file
// and in the emulator's faults file.

#include <string_view>

#include "document/reader.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Reads the keys that only a line fault has: `share` for a leak.
void read_own_keys(document::MapReader& reader, LineFault& fault);
/// Reads the keys that only a sensor fault has: for an offset, its size [mm] under the key `offset_key`.
void read_own_keys(document::MapReader& reader, SensorFault& fault, std::string_view offset_key);
/// Reads an object with the keys `position_mm` and `yielding`.
[[nodiscard]] PlantObject read_object(const document::Document& document, const document::Node& node,
                                      document::Problems& problems);

}  // namespace softgrip::simulation
