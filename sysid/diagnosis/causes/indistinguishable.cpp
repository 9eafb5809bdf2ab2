#include "sysid/diagnosis/causes/indistinguishable.h"

#include <algorithm>

namespace softgrip::sysid {

std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model) {
  const bool between = std::any_of(model.blocks.begin(), model.blocks.end(), [](const model::BlockSpec& b) {
    const Cause* const other = cause_of(b.type);
    return other != nullptr && other->makes_distinguishable;
  });
  return between ? std::nullopt : find_cause(cause.indistinguishable);
}

std::vector<Cause> sensor_counterparts(const Cause& cause) {
  std::vector<Cause> list;
  for (const std::string_view id : cause.counterparts) list.push_back(*find_cause(id));
  return list;
}

bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model) {
  const auto indistinguishable = indistinguishable_from(one, model);
  return indistinguishable && *indistinguishable == other;
}

}  // namespace softgrip::sysid
