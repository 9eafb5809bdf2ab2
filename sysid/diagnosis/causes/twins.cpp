#include "sysid/diagnosis/causes/twins.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace softgrip::sysid {
namespace {

constexpr std::array<std::string_view, 3> with_memory{"inertia", "backlash", "sensor_lag"};

}  // namespace

std::optional<Cause> twin_of(const Cause& cause, const model::Model& model) {
  const bool between = std::any_of(with_memory.begin(), with_memory.end(), [&](std::string_view id) {
    return model::position_of(model, id).has_value();
  });
  if (between) return std::nullopt;
  if (cause.id == "stiffening" || cause.id == "sensor_nonlinearity")
    return sensor_counterparts(cause).front();
  return std::nullopt;
}

std::vector<Cause> sensor_counterparts(const Cause& cause) {
  const auto causes = [](std::initializer_list<std::string_view> ids) {
    std::vector<Cause> list;
    for (const std::string_view id : ids) list.push_back(*find_cause(id));
    return list;
  };
  if (cause.id == "stiffening") return causes({"sensor_nonlinearity"});
  if (cause.id == "contact") return causes({"sensor_saturation", "sensor_nonlinearity"});
  if (cause.id == "sensor_nonlinearity") return causes({"stiffening"});
  if (cause.id == "sensor_saturation") return causes({"contact"});
  return {};
}

bool are_stops(const Cause& one, const Cause& other) {
  const auto is_stop = [](const Cause& cause) {
    return cause.id == "contact" || cause.id == "sensor_saturation";
  };
  return is_stop(one) && is_stop(other);
}

bool are_twins(const Cause& one, const Cause& other, const model::Model& model) {
  const auto twin = twin_of(one, model);
  return twin && twin->type == other.type;
}

}  // namespace softgrip::sysid
