#include <stdexcept>

#include "daemon/socket/sequence_loader.h"
#include "tests/world/world.h"

namespace softgrip::world {

Library load_library() {
  Library library;
  document::Problems problems;
  auto rig = rig::load_rig(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", problems);
  if (!rig) throw std::runtime_error(problems.format());
  library.rig = std::move(*rig);
  const daemon::SequenceLoader loader(library.rig.settings, "");
  for (const char* name : {"pick_stone", "track_sine", "empty_grip", "pressure_staircase", "hand_over"}) {
    auto sequence = loader.load_file(std::string(SOFTGRIP_SOURCE_DIR "/config/sequences/") + name + ".yaml");
    if (!sequence) throw std::runtime_error(sequence.error().format());
    library.sequences.push_back(*sequence);
  }
  return library;
}

}  // namespace softgrip::world
