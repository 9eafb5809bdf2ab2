#pragma once
// Simulates a record with a Chain<T>, where T is double or a number type with derivatives.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "model/chain.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Times after which a valve has settled, and after which all creep has settled [s].
inline constexpr double valve_settling_s = 10;
inline constexpr double creep_settling_s = 1e6;

/// Largest assumed duration of the motion at the arrival speed before the first sample [s].
inline constexpr double longest_arrival_s = 2;

/// Number of cycles between valley and peak that are simulated before the first sample. After these cycles,
/// the hysteresis is in its steady cycle.
inline constexpr int cycles_before = 15;

/// Returns the pressure [kPa] at which the motion to the first sample began. The returned pressure is not
/// beyond the last reversal. If the arrival speed is 0, the function returns the first pressure.
inline double arrived_from_kpa(double first_kpa, double last_turn_kpa, double arrival_kpa_per_s) {
  const double from_kpa = first_kpa - arrival_kpa_per_s * longest_arrival_s;
  return arrival_kpa_per_s > 0 ? std::clamp(from_kpa, std::min(last_turn_kpa, first_kpa), first_kpa)
                               : std::clamp(from_kpa, first_kpa, std::max(last_turn_kpa, first_kpa));
}

/// Returns time, temperature and supply pressure at sample `i`. If a column is missing, the default value is
/// returned.
inline model::Surroundings surroundings_at(const Record& record, std::size_t i) {
  model::Surroundings around;
  around.time_s = record.campaign_time_s + record.time_s[i];
  around.oscillation_shift_s = record.oscillation_shift_s;
  if (!record.temperature_c.empty()) around.temperature_c = record.temperature_c[i];
  if (!record.supply_kpa.empty()) around.supply_kpa = record.supply_kpa[i];
  return around;
}

/// Brings a chain to the state at the start of a record, with the reversals in its StartState. If there are a
/// peak and a valley, the chain begins at rest at the peak and passes `cycles_before` cycles, which end at
/// the valley. If there is only one of them, the chain begins at rest there. Then the chain moves to the
/// first pressure. If the arrival speed is 0, the chain settles at the first pressure. Otherwise the chain
/// settles at an earlier pressure and moves from there to the first pressure with the arrival speed. If there
/// are no reversals, the chain is at rest at the first pressure.
template <class T>
void start(model::Chain<T>& chain, const Record& record, const T& peak_before_kpa, const StartState& state) {
  const double first_kpa = record.drive_kpa.front();
  const double valley_kpa = state.valley_before_kpa;
  const bool turned = valley_kpa < first_kpa;
  // If a cycle consists of a valley and the first pressure, the first pressure is the peak of this cycle.
  const bool peaked =
      turned ? model::value_of(peak_before_kpa) >= first_kpa : model::value_of(peak_before_kpa) > first_kpa;
  // Blocks that depend on the largest load so far include the load of the earlier records.
  chain.reset(T(record.largest_before_kpa));
  chain.rest(peaked ? peak_before_kpa : T(turned ? valley_kpa : first_kpa));
  if (!peaked && !turned) return;
  // Blocks that depend on the time (drift, ageing) keep their values at the first sample.
  const model::Surroundings around = surroundings_at(record, 0);
  const auto settle_at = [&](double pressure_kpa) {
    chain.step(T(0.0), T(pressure_kpa), around);
    chain.step(T(valve_settling_s), T(pressure_kpa), around);
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
  chain.step(T(creep_settling_s), T(from_kpa), around);
  if (from_kpa != first_kpa)
    chain.step(T((first_kpa - from_kpa) / state.arrival_kpa_per_s), T(first_kpa), around);
}

/// Brings a chain to the state at the start of a record whose StartState contains neither a valley nor an
/// arrival speed. The peak is used only if the initial state of the record is unknown.
template <class T>
void start(model::Chain<T>& chain, const Record& record, const T& peak_before_kpa) {
  start(chain, record, record.start_unknown ? peak_before_kpa : T(record.drive_kpa.front()), StartState{});
}

/// Returns the drive at the end of the step to sample `i` >= 1 [kPa].
inline double drive_at_end(const Record& record, std::size_t i) {
  return record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
}

/// Simulates a record and calls sink(i, displacement) for each sample. The displacement includes neither the
/// offset nor the creep that is still in progress at the start of the record.
template <class T, class Sink>
void walk(const model::Model& model, std::span<const T> values, const Record& record,
          const T& peak_before_kpa, const StartState& state, Sink&& sink) {
  model::Chain<T> chain(model, values, record.sample_time_s);
  start(chain, record, peak_before_kpa, state);
  sink(std::size_t{0}, chain.reading_mm());
  for (std::size_t i = 1; i < record.size(); ++i) {
    model::Surroundings around = surroundings_at(record, i);
    around.oscillation_shift_s += state.oscillation_shift_s;
    const T end(drive_at_end(record, i));
    if (record.held) chain.step(T(0.0), end, around);
    sink(i, chain.step(T(record.duration_s[i]), end, around));
  }
}

}  // namespace softgrip::sysid
