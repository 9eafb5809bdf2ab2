#include "sysid/diagnosis/experiment_advice.h"

#include <algorithm>
#include <array>

#include "sysid/diagnosis/cause.h"

namespace softgrip::sysid {
namespace {

using Station = model::Station;

bool is_any(std::string_view id, std::initializer_list<std::string_view> ids) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

bool both(std::string_view one, std::string_view other, std::initializer_list<std::string_view> ids) {
  return is_any(one, ids) && is_any(other, ids);
}

bool either(std::string_view one, std::string_view other, std::initializer_list<std::string_view> ids) {
  return is_any(one, ids) || is_any(other, ids);
}

std::string names(std::string_view one, std::string_view other) {
  return std::string(one) + " and " + std::string(other);
}

}  // namespace

std::vector<std::string> advice_for(std::string_view one, std::string_view other, const AdviceFacts& facts) {
  std::vector<std::string> advice;
  const auto first = find_cause(one);
  const auto second = find_cause(other);
  const bool one_in_valve =
      first && second && (first->station == Station::valve) != (second->station == Station::valve);
  if (one_in_valve && !facts.pressure_recorded) {
    advice.push_back("record pressure_kpa (the valve's own pressure): it says at once which of " +
                     names(one, other) + " it is");
  }
  if (either(one, other, {"thermal_gain"}) ||
      (!facts.temperature_varies && both(one, other, {"ageing", "stress_softening", "sensor_drift"}))) {
    advice.push_back(
        "add a temperature_c column and repeat at another temperature: a gain that follows it is neither "
        "wear nor drift");
  }
  if (facts.separable) return advice;
  if (both(one, other, {"stiffening", "sensor_nonlinearity"})) {
    advice.emplace_back(
        "without a change of load stiffening and sensor_nonlinearity give equal readings, whatever the "
        "pressure: check the sensor against a gauge, or change the load (the bend moves with the finger's "
        "force, a bent scale stays where it is)");
  } else if (both(one, other, {"contact", "stiffening", "sensor_nonlinearity", "sensor_saturation"})) {
    advice.push_back("change the load or move the object: what breaks at the same reading again is the " +
                     std::string("sensor or a stop, not the actuator"));
  } else if (both(one, other, {"sensor_drift", "slow_creep", "ageing"})) {
    advice.push_back("leave the finger vented for an hour and read its zero: no waveform in the menu tells " +
                     names(one, other) + " apart");
  } else if (advice.empty()) {
    advice.push_back("no waveform in the menu tells " + names(one, other) +
                     " apart within the rig's limits: less noise or a larger pressure would be needed");
  }
  return advice;
}

}  // namespace softgrip::sysid
