#pragma once
// Control commands of the emulator, one line each, for scripts and people:
//
//   status                 one line of JSON: the truth about board, fingers and faults
//   fault NAME             begins a fault of the faults file
//   clear NAME             ends it
//   object out | back      pulls the object out, puts it back
//   object stone | screw | POSITION_MM[:YIELDING]    another object
//   quit

#include <optional>
#include <string>
#include <string_view>

#include "simulation/emulator/emulator.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// An object as users write it: "stone", "screw", "13", "13:0.2".
[[nodiscard]] std::optional<simulation::PlantObject> object_named(std::string_view text);

struct ControlAnswer {
  std::string line;  ///< "ok", "error: ...", or what was asked for; no line break
  bool quit = false;
};

/// Carries out one line at `now`.
[[nodiscard]] ControlAnswer control(Emulator& emulator, Nanoseconds now, std::string_view line);

}  // namespace softgrip::simulation
