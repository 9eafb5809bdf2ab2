#include "sysid/diagnosis/verdict/untested_causes.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "model/blocks/valve_stiction.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/sensor_drift.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/evidence/loop_phase.h"
#include "sysid/evidence/signature.h"
#include "sysid/logs/excitation.h"

namespace softgrip::sysid {
namespace {

void reject_drift(Diagnosis& d) {
  const auto is_drift = [](const NamedCause& named) { return named.cause.id == causes::SensorDrift::id; };
  const auto first = std::stable_partition(d.causes.begin(), d.causes.end(), std::not_fn(is_drift));
  if (first == d.causes.end()) return;
  std::move(first, d.causes.end(), std::back_inserter(d.partial));
  d.causes.erase(first, d.causes.end());
  d.verdict = d.causes.empty() ? Verdict::unexplained : Verdict::partly_explained;
  d.warnings.emplace_back(
      "A slow change of unknown origin: no log contains a rest without pressure, so a drift of the sensor "
      "cannot be separated from a change of the finger");
}

NamedCause sticking_valve() {
  NamedCause named;
  named.cause = *find_cause(causes::ValveDeadband::id);
  named.block_type = model::block_type<model::ValveStiction>();
  return named;
}

}  // namespace

void correct_by_logs(Diagnosis& d, const std::vector<Log>& logs) {
  if (!contains_rest(logs)) {
    d.not_tested.emplace(causes::SensorDrift::id, recording_for(Appears::at_rest));
    reject_drift(d);
  }
  const auto is_closed = [](const Log& log) {
    return is_closed_loop(log.pressure_command_kpa, log.displacement_mm);
  };
  const auto sticks = [](const Log& log) {
    return shows_stiction(log.pressure_command_kpa, log.displacement_mm);
  };
  if (!std::all_of(logs.begin(), logs.end(), is_closed)) return;
  d.warnings.emplace_back(
      "The command depends on the readings (closed loop), so the command contains the noise of the readings. "
      "A simulation with this command is therefore uncertain");
  if (!std::all_of(logs.begin(), logs.end(), sticks)) return;
  d.warnings.emplace_back(
      "The phase shift between command and reading indicates a sticking valve (Horch 1999)");
  std::erase_if(d.causes,
                [](const NamedCause& named) { return named.cause.id == causes::ValveDeadband::id; });
  std::move(d.causes.begin(), d.causes.end(), std::back_inserter(d.partial));
  d.causes = {sticking_valve()};
  d.verdict = Verdict::partly_explained;
}

}  // namespace softgrip::sysid
