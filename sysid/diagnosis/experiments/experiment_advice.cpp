#include "sysid/diagnosis/experiments/experiment_advice.h"

#include <algorithm>

#include "base/numbers.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/gauge/gauge_file.h"

namespace softgrip::sysid {
namespace {

bool has(const Cause& cause, Advice advice) {
  return std::find(cause.advice.begin(), cause.advice.end(), advice) != cause.advice.end();
}

constexpr const char* vary_temperature =
    "Add a temperature_c column and repeat the run at a different temperature. If the gain depends on the "
    "temperature, the cause is not wear or drift.";

/// Returns the advice for two causes that no waveform can separate: change the load, or leave the finger
/// vented. Returns an empty text if neither action separates them.
std::string instead_of_waveform(const Cause& one, const Cause& other, const std::string& names,
                                bool gauge_made) {
  if (has(one, Advice::change_load) && has(other, Advice::change_load)) {
    return std::string(gauge_made
                           ? "The gauge check was not conclusive. Repeat the check with more positions over "
                             "a wider range, or change the load or move the object that the finger touches"
                           : "Change the load or move the object that the finger touches") +
           ". A nonlinearity that stays at the same reading is caused by the sensor. A nonlinearity that "
           "moves with the load is not caused by the sensor.";
  }
  if (has(one, Advice::leave_vented) && has(other, Advice::leave_vented)) {
    return "Leave the finger vented for an hour and record the zero offset of the sensor, because no "
           "waveform in softgrip's list of experiments separates " +
           names + ".";
  }
  return {};
}

}  // namespace

std::vector<std::string> advice_for(std::string_view one, std::string_view other, const AdviceFacts& facts) {
  const std::string names = std::string(one) + " and " + std::string(other);
  const Cause first = find_cause(one).value_or(Cause{});
  const Cause second = find_cause(other).value_or(Cause{});
  std::vector<std::string> advice;
  const bool known = !first.id.empty() && !second.id.empty();
  const bool one_in_valve =
      known && (first.station == model::Station::valve) != (second.station == model::Station::valve);
  if (one_in_valve && !facts.pressure_recorded) {
    advice.push_back("Record pressure_kpa, the pressure at the valve, because this signal separates " +
                     names + ".");
  }
  const bool may_be_warmth =
      has(first, Advice::record_temperature) && has(second, Advice::record_temperature);
  if (has(first, Advice::vary_temperature) || has(second, Advice::vary_temperature) ||
      (may_be_warmth && !facts.temperature_varies)) {
    advice.emplace_back(vary_temperature);
  }
  if (facts.separable) return advice;
  std::string instead = instead_of_waveform(first, second, names, facts.gauge_made);
  if (instead.empty() && advice.empty() && !facts.may_be_pressurised) {
    instead =
        "No experiment was designed to separate " + names +
        ", because the logs contain no pressure above 0. softgrip designs experiments only for positive "
        "pressures.";
  } else if (instead.empty() && advice.empty()) {
    instead = "No waveform in softgrip's list of experiments separates " + names +
              " within the limits of the rig. A separation requires less sensor noise or a higher pressure.";
  }
  if (!instead.empty()) advice.push_back(std::move(instead));
  return advice;
}

std::string gauge_advice(const std::vector<double>& positions_mm, const std::vector<std::string>& separates) {
  const std::vector<double> distinct = distinct_positions(positions_mm);
  std::string ids;
  for (std::size_t i = 0; i < separates.size(); ++i)
    ids += (i == 0 ? "" : i + 1 == separates.size() ? " and " : ", ") + separates[i];
  return "Check the sensor against a gauge, because " + ids +
         " give equal readings at all pressures. Place the target at " + std::to_string(distinct.size()) +
         " known positions from " + significant(distinct.front(), 3) + " to " +
         significant(distinct.back(), 3) +
         " mm, first in increasing, then in decreasing and then again in increasing order. Write the reading "
         "of the sensor at each position to " +
         gauge_positions_file + ", and diagnose again with --gauge " + gauge_positions_file;
}

}  // namespace softgrip::sysid
