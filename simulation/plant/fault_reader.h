#pragma once
// Reads the faults of a finger from YAML. The keys and limits are equal in the events of a rig file and in
// the emulator's faults file.

#include <string_view>

#include "document/reader.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Reads the additional keys of a line fault: `share` for a leak.
void read_own_keys(document::MapReader& reader, LineFault& fault);
/// Reads the additional keys of a sensor fault: for an offset, its size [mm], which is the value of
/// `offset_key`.
void read_own_keys(document::MapReader& reader, SensorFault& fault, std::string_view offset_key);
/// Reads an object: `{position_mm, yielding}`.
[[nodiscard]] PlantObject read_object(const document::Document& document, const document::Node& node,
                                      document::Problems& problems);

}  // namespace softgrip::simulation
