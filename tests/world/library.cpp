#include <stdexcept>
#include <utility>

#include "daemon/socket/sequence_loader.h"
#include "tests/world/world.h"

namespace softgrip::world {
namespace {

const std::string examples_folder = SOFTGRIP_SOURCE_DIR "/config/";

rig::RigFile load_example(const std::string& path) {
  document::Problems problems;
  auto rig = rig::load_rig(examples_folder + path, problems);
  if (!rig) throw std::runtime_error(problems.format());
  return std::move(*rig);
}

Library with_sequences(rig::RigFile rig, std::vector<std::string> sequence_paths) {
  Library library;
  library.rig = std::move(rig);
  const daemon::SequenceLoader loader(library.rig.settings, "");
  for (const char* name : {"pick_stone", "track_sine", "empty_grip", "pressure_staircase", "hand_over"})
    sequence_paths.push_back(std::string("sequences/") + name);
  for (const std::string& name : sequence_paths) {
    auto sequence = loader.load_file(examples_folder + name + ".yaml");
    if (!sequence) throw std::runtime_error(sequence.error().format());
    library.sequences.push_back(*sequence);
  }
  return library;
}

}  // namespace

Library load_library() {
  Library library = with_sequences(load_example("rig.yaml"), {});
  const auto& stones = std::get<simulation::SimulatedBoardSettings>(library.rig.board).channels;
  for (const double rest_kpa : {0.0, 10.0}) {
    rig::RigFile rig = load_example("vacuum/rig.yaml");
    auto& fingers = std::get<simulation::SimulatedBoardSettings>(rig.board).channels;
    for (std::size_t i = 0; i < fingers.size(); ++i) {
      fingers[i].plant.object = stones[i].plant.object;
      rig.settings.channels[i].limits.rest_kpa = rest_kpa;
    }
    library.others.push_back(with_sequences(std::move(rig), {"vacuum/sequences/vacuum_grip"}));
  }
  return library;
}

}  // namespace softgrip::world
