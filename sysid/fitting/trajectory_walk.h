#pragma once
// The walk of a record through a Chain<T>; included where a T is chosen (double, automatic differentiation).

#include <cmath>
#include <cstddef>
#include <span>

#include "model/chain.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Long enough for a valve, and then for any creep, to settle before the first sample.
inline constexpr double valve_settling_s = 10;
inline constexpr double creep_settling_s = 1e6;

/// Brings a chain to where a record begins: at rest at its first pressure or, where the pressure was higher
/// before, at rest there and then released.
template <class T>
void start(model::Chain<T>& chain, const Record& record, const T& peak_before_kpa) {
  const T first(record.drive_kpa.front());
  // What remembers the largest load so far has seen that of the earlier records.
  chain.reset(T(record.largest_before_kpa));
  if (!record.start_unknown || !(model::value_of(peak_before_kpa) > record.drive_kpa.front())) {
    chain.rest(first);
    return;
  }
  chain.rest(peak_before_kpa);
  chain.step(T(0.0), first);
  chain.step(T(valve_settling_s), first);
  chain.step(T(creep_settling_s), first);
}

/// What surrounds the rig at the end of sample `i`; without a column the usual.
inline model::Surroundings surroundings_at(const Record& record, std::size_t i) {
  model::Surroundings around;
  around.time_s = record.campaign_time_s + record.time_s[i];
  if (!record.temperature_c.empty()) around.temperature_c = record.temperature_c[i];
  if (!record.supply_kpa.empty()) around.supply_kpa = record.supply_kpa[i];
  return around;
}

/// The drive at the end of the step to sample `i` >= 1 [kPa].
inline double drive_at_end(const Record& record, std::size_t i) {
  return record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
}

/// Calls sink(i, displacement) for every sample. The displacement lacks the offset and the unsettled creep.
template <class T, class Sink>
void walk(const model::Model& model, std::span<const T> values, const Record& record,
          const T& peak_before_kpa, Sink&& sink) {
  model::Chain<T> chain(model, values, record.sample_time_s);
  start(chain, record, peak_before_kpa);
  sink(std::size_t{0}, chain.reading_mm());
  for (std::size_t i = 1; i < record.size(); ++i) {
    const model::Surroundings around = surroundings_at(record, i);
    const T end(drive_at_end(record, i));
    if (record.held) chain.step(T(0.0), end, around);
    sink(i, chain.step(T(record.duration_s[i]), end, around));
  }
}

}  // namespace softgrip::sysid
