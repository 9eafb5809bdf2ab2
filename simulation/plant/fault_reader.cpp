#include "simulation/plant/fault_reader.h"

namespace softgrip::simulation {
namespace {

constexpr document::Range reach_mm{-1000, 1000};

}  // namespace

void read_own_keys(document::MapReader& reader, LineFault& fault) {
  if (fault.kind == LineFault::Kind::leaking) fault.share = reader.number("share", {0, 1});
}

void read_own_keys(document::MapReader& reader, SensorFault& fault, std::string_view offset_key) {
  if (fault.kind == SensorFault::Kind::offset) fault.value_mm = reader.number(offset_key, reach_mm);
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
