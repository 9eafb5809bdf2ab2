#include "simulation/plant/fault_reader.h"

namespace softgrip::simulation {
namespace {

constexpr document::Range reach_mm{-1000, 1000};

}  // namespace

document::Key<LineFault> leak_key() {
  return document::required("share", &LineFault::share, {0, 1},
                            "share of the commanded pressure that is lost");
}

document::Key<SensorFault> offset_key(std::string name) {
  return document::required(std::move(name), &SensorFault::value_mm, reach_mm, "offset of the reading");
}

PlantObject read_object(const document::Document& document, const document::Node& node,
                        document::Problems& problems) {
  document::MapReader reader(document, node, problems, "object");
  PlantObject object;
  object.position_mm = reader.number("position_mm", reach_mm);
  object.yielding = reader.number("yielding", {0, 1});
  return object;
}

}  // namespace softgrip::simulation
