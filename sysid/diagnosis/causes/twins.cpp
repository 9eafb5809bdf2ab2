#include "sysid/diagnosis/causes/twins.h"

#include <algorithm>

namespace softgrip::sysid {

std::optional<Cause> twin_of(const Cause& cause, const model::Model& model) {
  const bool between = std::any_of(model.blocks.begin(), model.blocks.end(), [](const model::BlockSpec& b) {
    const Cause* const other = cause_of(b.type);
    return other != nullptr && other->parts_twins;
  });
  return between ? std::nullopt : find_cause(cause.twin);
}

std::vector<Cause> sensor_counterparts(const Cause& cause) {
  std::vector<Cause> list;
  for (const std::string_view id : cause.counterparts) list.push_back(*find_cause(id));
  return list;
}

bool are_twins(const Cause& one, const Cause& other, const model::Model& model) {
  const auto twin = twin_of(one, model);
  return twin && *twin == other;
}

}  // namespace softgrip::sysid
