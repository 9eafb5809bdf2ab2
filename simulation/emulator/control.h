#pragma once
// Control commands of the emulator for scripts and users, one line each:
//
//   status                 one line of JSON: true state of board, fingers and faults
//   fault NAME             begins a fault of the faults file
//   clear NAME             ends the fault NAME
//   object out | back      removes the object, or puts it back
//   object stone | screw | POSITION_MM[:YIELDING]    sets another object
//   quit                   ends the emulator

#include <optional>
#include <string>
#include <string_view>

#include "simulation/emulator/emulator.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Returns the object that a text of a user describes ("stone", "screw", "13", "13:0.2"), or nullopt.
[[nodiscard]] std::optional<simulation::PlantObject> object_named(std::string_view text);

struct ControlAnswer {
  std::string line;   ///< "ok", "error: ..." or the status, without line break
  bool quit = false;  ///< the command requests the end of the emulator
};

/// Executes one command line at `now`.
[[nodiscard]] ControlAnswer control(Emulator& emulator, Nanoseconds now, std::string_view line);

}  // namespace softgrip::simulation
