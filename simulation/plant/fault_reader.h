#pragma once
// Reads the faults of a finger from YAML, with equal words and bounds for the events of a rig file and the
// emulator's faults file.

#include <string_view>

#include "document/reader.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Reads the keys of a line fault in addition to its kind: `share` of a leak.
void read_own_keys(document::MapReader& reader, LineFault& fault);
/// Reads the keys of a sensor fault in addition to its kind: its size under `offset_key` [mm].
void read_own_keys(document::MapReader& reader, SensorFault& fault, std::string_view offset_key);
/// `{position_mm, yielding}`
[[nodiscard]] PlantObject read_object(const document::Document& document, const document::Node& node,
                                      document::Problems& problems);

}  // namespace softgrip::simulation
