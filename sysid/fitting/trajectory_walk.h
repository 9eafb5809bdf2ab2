#pragma once
// Simulation of a record with a Chain<T>, for any number type T (double, or with derivatives).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "model/chain.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Durations [s] after which a valve, or any creep, has settled before the first sample.
inline constexpr double valve_settling_s = 10;
inline constexpr double creep_settling_s = 1e6;

/// Maximum duration [s] for which the pressure moved at its arrival speed before the first sample.
inline constexpr double longest_arrival_s = 2;

/// Number of cycles between a peak and a valley before the first sample, so that the hysteresis is in its
/// steady cycle.
inline constexpr int cycles_before = 15;

/// Returns the pressure [kPa] at which the final movement to the first sample began. It is not beyond the
/// last reversal. Without an arrival speed, it is the first pressure.
inline double arrived_from_kpa(double first_kpa, double last_turn_kpa, double arrival_kpa_per_s) {
  const double from_kpa = first_kpa - arrival_kpa_per_s * longest_arrival_s;
  return arrival_kpa_per_s > 0 ? std::clamp(from_kpa, std::min(last_turn_kpa, first_kpa), first_kpa)
                               : std::clamp(from_kpa, first_kpa, std::max(last_turn_kpa, first_kpa));
}

/// Brings a chain to the start of a record by the reversals in its StartState: from rest at the peak to the
/// valley, then to the first pressure. There the chain settles, or it arrives at the arrival speed. Without
/// reversals, the chain is at rest at the first pressure.
template <class T>
void start(model::Chain<T>& chain, const Record& record, const T& peak_before_kpa, const StartState& state) {
  const double first_kpa = record.drive_kpa.front();
  const double valley_kpa = state.valley_before_kpa;
  const bool turned = valley_kpa < first_kpa;
  // A cycle between a valley and the first pressure has its peak there.
  const bool peaked =
      turned ? model::value_of(peak_before_kpa) >= first_kpa : model::value_of(peak_before_kpa) > first_kpa;
  // Blocks that depend on the largest load so far include the load of the earlier records.
  chain.reset(T(record.largest_before_kpa));
  chain.rest(peaked ? peak_before_kpa : T(turned ? valley_kpa : first_kpa));
  if (!peaked && !turned) return;
  const auto settle_at = [&](double pressure_kpa) {
    chain.step(T(0.0), T(pressure_kpa));
    chain.step(T(valve_settling_s), T(pressure_kpa));
  };
  if (peaked && turned) {
    for (int cycle = 1; cycle < cycles_before; ++cycle) {
      settle_at(valley_kpa);
      settle_at(model::value_of(peak_before_kpa));
    }
    settle_at(valley_kpa);
  }
  const double last_turn_kpa = turned ? valley_kpa : model::value_of(peak_before_kpa);
  const double from_kpa = arrived_from_kpa(first_kpa, last_turn_kpa, state.arrival_kpa_per_s);
  settle_at(from_kpa);
  chain.step(T(creep_settling_s), T(from_kpa));
  if (from_kpa != first_kpa) chain.step(T((first_kpa - from_kpa) / state.arrival_kpa_per_s), T(first_kpa));
}

/// Brings a chain to the start of a record without a valley and an arrival speed. The peak is used only if
/// the start of the record is unknown.
template <class T>
void start(model::Chain<T>& chain, const Record& record, const T& peak_before_kpa) {
  start(chain, record, record.start_unknown ? peak_before_kpa : T(record.drive_kpa.front()), StartState{});
}

/// Returns time, temperature and supply pressure at sample `i`. A missing column gives the default value.
inline model::Surroundings surroundings_at(const Record& record, std::size_t i) {
  model::Surroundings around;
  around.time_s = record.campaign_time_s + record.time_s[i];
  if (!record.temperature_c.empty()) around.temperature_c = record.temperature_c[i];
  if (!record.supply_kpa.empty()) around.supply_kpa = record.supply_kpa[i];
  return around;
}

/// Returns the drive at the end of the step to sample `i` >= 1 [kPa].
inline double drive_at_end(const Record& record, std::size_t i) {
  return record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
}

/// Calls sink(i, displacement) for each sample. The displacement does not include the offset and the
/// unsettled creep.
template <class T, class Sink>
void walk(const model::Model& model, std::span<const T> values, const Record& record,
          const T& peak_before_kpa, const StartState& state, Sink&& sink) {
  model::Chain<T> chain(model, values, record.sample_time_s);
  start(chain, record, peak_before_kpa, state);
  sink(std::size_t{0}, chain.reading_mm());
  for (std::size_t i = 1; i < record.size(); ++i) {
    const model::Surroundings around = surroundings_at(record, i);
    const T end(drive_at_end(record, i));
    if (record.held) chain.step(T(0.0), end, around);
    sink(i, chain.step(T(record.duration_s[i]), end, around));
  }
}

}  // namespace softgrip::sysid
