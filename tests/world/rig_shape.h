#pragma once
// The rigs of the worlds: the example rig with other rates, patience, slew and watchdogs.

#include <cstdint>
#include <string>

#include "rig/rig_file.h"

namespace softgrip::world {

struct RigShape {
  rig::RigFile rig;
  std::uint64_t seed = 0;
  Nanoseconds watchdog = 0;
  bool trip_latches = true;
  std::string text;
};

[[nodiscard]] RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed);

}  // namespace softgrip::world
