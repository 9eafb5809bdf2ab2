#include "sysid/diagnosis/experiments/experiment_advice.h"

#include <algorithm>
#include <array>

#include "base/numbers.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/gauge/gauge_file.h"

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
  if (both(one, other, {"stiffening", "contact", "sensor_nonlinearity", "sensor_saturation"})) {
    advice.push_back(
        std::string(facts.gauge_made ? "the gauge left it open: read it again, finer and further, or change "
                                       "the load or move the object"
                                     : "change the load or move the object") +
        ": what breaks at the same reading again is the sensor, what moves with the load is not");
  } else if (both(one, other, {"sensor_drift", "slow_creep", "ageing"})) {
    advice.push_back("leave the finger vented for an hour and read its zero: no waveform in the menu tells " +
                     names(one, other) + " apart");
  } else if (advice.empty()) {
    advice.push_back("no waveform in the menu tells " + names(one, other) +
                     " apart within the rig's limits: less noise or a larger pressure would be needed");
  }
  return advice;
}

std::string gauge_advice(const std::vector<double>& positions_mm, const std::vector<std::string>& separates) {
  const std::vector<double> distinct = distinct_positions(positions_mm);
  std::string ids;
  for (std::size_t i = 0; i < separates.size(); ++i)
    ids += (i == 0 ? "" : i + 1 == separates.size() ? " and " : ", ") + separates[i];
  return "check the sensor against a gauge: " + ids +
         " give equal readings whatever the pressure. Put the target at " + std::to_string(distinct.size()) +
         " known positions from " + significant(distinct.front(), 3) + " to " +
         significant(distinct.back(), 3) +
         " mm, up, down and up again, write what the sensor reads beside each of them in " +
         gauge_positions_file + ", and diagnose again with --gauge " + gauge_positions_file;
}

}  // namespace softgrip::sysid
