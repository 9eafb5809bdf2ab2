#include "sysid/logs/simulated_log.h"

#include <cmath>

#include "base/random.h"
#include "model/chain.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

// Number from which the seed of the added noise is derived, so that this noise is independent of the noise of
// the model.
constexpr std::uint64_t added_noise = 1;

/// Returns the sampling interval of a log with constant interval, or 0 for any other log.
double sample_time_of(const Log& log) {
  return log.size() < 2 ? 0 : sampling_of(log).sample_time_s();
}

/// Returns a copy of a column without missing values; empty if the column has no value.
std::vector<double> filled(std::vector<double> column) {
  if (finite_count(column) == 0) return {};
  fill_missing(column);
  return column;
}

}  // namespace

Log sampled_signal(model::SignalName signal, double rate_hz) {
  Log log;
  log.name = model::name_of(signal);
  // The term 1e-6 compensates the rounding of the duration. Without this term, the last sample could be
  // missing.
  const auto intervals = static_cast<std::size_t>(std::floor(model::duration_s(signal) * rate_hz + 1e-6));
  for (std::size_t i = 0; i <= intervals; ++i) {
    const double time_s = static_cast<double>(i) / rate_hz;
    log.time_s.push_back(time_s);
    log.pressure_command_kpa.push_back(model::value_kpa(signal, time_s));
  }
  return log;
}

void simulate(const model::Model& model, const SimulationSettings& settings, Log& log) {
  log.displacement_mm.assign(log.size(), 0);
  if (log.size() == 0) return;
  model::Chain<double> chain(model, {}, sample_time_of(log), settings.seed);
  const std::uint64_t noise_seed = derived_seed(settings.seed, added_noise);
  chain.reset(log.pressure_command_kpa.front());
  log.output_unit = model.output_unit;
  const std::vector<double> supply_kpa = filled(log.supply_kpa), temperature_c = filled(log.temperature_c);
  double previous_s = log.time_s.front();
  for (std::size_t i = 0; i < log.size(); ++i) {
    const double duration_s = log.time_s[i] - previous_s;
    model::Surroundings surroundings;
    surroundings.time_s = log.time_s[i];
    if (!supply_kpa.empty()) surroundings.supply_kpa = supply_kpa[i];
    if (!temperature_c.empty()) surroundings.temperature_c = temperature_c[i];
    const std::size_t driving = settings.held && i > 0 ? i - 1 : i;
    if (settings.held) chain.step(0, log.pressure_command_kpa[driving], surroundings);
    const double reading_mm = chain.step(duration_s, log.pressure_command_kpa[driving], surroundings);
    previous_s = log.time_s[i];
    const double noise_mm = settings.noise_mm > 0 ? settings.noise_mm * normal_at(noise_seed, i) : 0;
    log.displacement_mm[i] = reading_mm + noise_mm;
  }
}

}  // namespace softgrip::sysid
