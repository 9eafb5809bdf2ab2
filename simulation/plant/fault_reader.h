#pragma once
// Declares the keys of the faults of a finger. The events of a rig file and the faults file of the emulator
// have the same keys with the same limits.

#include <string>
#include <utility>

#include "document/schema.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

inline constexpr document::Range reach_mm{-1000, 1000};

/// Returns the key of a leak, which the line fault `leaking` requires.
[[nodiscard]] inline document::Key<LineFault> leak_key() {
  return document::required("share", &LineFault::share, {0, 1},
                            "share of the commanded pressure that is lost");
}
/// Returns the key with the name `name` for the size of an offset [mm], which the sensor fault `offset`
/// requires.
[[nodiscard]] inline document::Key<SensorFault> offset_key(std::string name) {
  return document::required(std::move(name), &SensorFault::value_mm, reach_mm, "offset of the reading");
}
/// Reads an object with the keys `position_mm` and `yielding`.
[[nodiscard]] inline PlantObject read_object(const document::Document& document, const document::Node& node,
                                             document::Problems& problems) {
  document::MapReader reader(document, node, problems, "object");
  PlantObject object;
  object.position_mm = reader.number("position_mm", reach_mm);
  object.yielding = reader.number("yielding", {0, 1});
  return object;
}

}  // namespace softgrip::simulation
