#pragma once
// Executes the control commands of the emulator. Scripts and users send each command as a line:
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

/// Returns the object that a text describes, for example "stone", "screw", "13" or "13:0.2". Returns nullopt
/// if the text describes no object.
[[nodiscard]] std::optional<simulation::PlantObject> object_named(std::string_view text);

struct ControlAnswer {
  std::string line;   ///< reply to the command: "ok", "error: ..." or the status, without a line break
  bool quit = false;  ///< true: the command requests that the emulator ends
};

/// Executes one command line at the time `now`.
[[nodiscard]] ControlAnswer control(Emulator& emulator, Nanoseconds now, std::string_view line);

}  // namespace softgrip::simulation
