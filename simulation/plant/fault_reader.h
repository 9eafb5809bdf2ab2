#pragma once
// Reads the faults of a finger from YAML. The events of a rig file and the faults file of the emulator have
// the same keys with the same limits.

#include <string_view>

#include "document/reader.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Reads the keys that depend on the kind of a line fault: `share` for a leak.
void read_own_keys(document::MapReader& reader, LineFault& fault);
/// Reads the keys that depend on the kind of a sensor fault: for an offset, the size of the offset [mm] under
/// the key `offset_key`.
void read_own_keys(document::MapReader& reader, SensorFault& fault, std::string_view offset_key);
/// Reads an object with the keys `position_mm` and `yielding`.
[[nodiscard]] PlantObject read_object(const document::Document& document, const document::Node& node,
                                      document::Problems& problems);

}  // namespace softgrip::simulation
