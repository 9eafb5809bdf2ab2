#pragma once
// Executes control commands of the emulator, which scripts and users send as single lines:
//
//   status                 one line of JSON: true state of board, fingers and faults
//   fault NAME             begins the fault NAME of the faults file
//   clear NAME             ends the fault NAME
//   object out | back      removes the object, or puts the same object back
//   object stone | screw | POSITION_MM[:YIELDING]    puts a new object between the fingers
//   quit                   ends the emulator

#include <optional>
#include <string>
#include <string_view>

#include "simulation/emulator/emulator.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// Returns the object that a text describes ("stone", "screw", "13", "13:0.2"), or nullopt for any other
/// text.
[[nodiscard]] std::optional<simulation::PlantObject> object_named(std::string_view text);

struct ControlAnswer {
  std::string line;   ///< reply to the command: "ok", "error: ..." or the status, without a line break
  bool quit = false;  ///< true: the command requests the end of the emulator
};

/// Executes one command line at the time `now`.
[[nodiscard]] ControlAnswer control(Emulator& emulator, Nanoseconds now, std::string_view line);

}  // namespace softgrip::simulation
