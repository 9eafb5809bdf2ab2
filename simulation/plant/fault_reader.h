#pragma once
// What can be wrong with a finger, as YAML says it: the same words and bounds in the events of a rig file and
// in the emulator's faults file.

#include <string_view>

#include "document/reader.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Reads what a fault of this kind has beside its kind: `share` of a line that leaks.
void read_own_keys(document::MapReader& reader, LineFault& fault);
/// The same: of a sensor that is off by how much, under `offset_key` [mm].
void read_own_keys(document::MapReader& reader, SensorFault& fault, std::string_view offset_key);
/// `{position_mm, yielding}`
[[nodiscard]] PlantObject read_object(const document::Document& document, const document::Node& node,
                                      document::Problems& problems);

}  // namespace softgrip::simulation
