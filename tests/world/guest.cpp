#include "tests/world/guest.h"

#include <variant>

#include "tests/world/blocks_in_world.h"
#include "tests/world/plc_in_world.h"
#include "tests/world/runs_in_world.h"

namespace softgrip::world {

std::unique_ptr<Guest> make_guest(Tool tool, Host& host) {
  switch (tool) {
    case Tool::run:
      return make_run(host);
    case Tool::baseline:
      return make_baseline(host);
    case Tool::experiment:
      return make_experiment(host);
    case Tool::plc:
      return make_plc(host);
    case Tool::blocks:
      return make_blocks(host);
    case Tool::none:
    case Tool::calibrate:
    case Tool::doctor:
      break;
  }
  return nullptr;
}

RigShape shape_for(Tool tool, const rig::RigFile& example, std::uint64_t seed, bool always_habits) {
  RigShape shape = draw_shape(example, seed);
  draw_habits(shape, always_habits);
  // An experiment ends immediately if an object obstructs the finger. The rigs for experiments therefore
  // contain no objects.
  if (tool == Tool::baseline || tool == Tool::experiment) {
    for (auto& channel : std::get<simulation::SimulatedBoardSettings>(shape.rig.board).channels)
      channel.plant.object.reset();
  }
  return shape;
}

}  // namespace softgrip::world
