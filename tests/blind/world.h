#pragma once
// A world that may hide an effect: an actuator of its own, integrated by its own method at a fine step.
// This program links nothing of the project. Its equations follow the vocabulary of causes, not the blocks.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace blind {

/// The actuator without effects. Pressures in kPa, displacement in mm, time in s.
struct Base {
  double alpha = 0.35;           // mm/kPa
  double beta = 0.20;            // mm/kPa
  double gamma = 0.03;           // 1/kPa
  double eta = 0.05;             // 1/kPa
  double instantaneous = 0.003;  // 1/k0, mm/kPa
  double fast_gain = 0.25, fast_tau = 0.4;
  double slow_gain = 0.056, slow_tau = 13.7;
};

/// The hidden effects: id -> its numbers by name. Ids of the cause vocabulary, or of outside_ids().
using Effect = std::map<std::string, double>;
using Effects = std::map<std::string, Effect>;

struct Sensor {
  double noise_mm = 0.04;
  double step_mm = 0.01;
  double pressure_noise_kpa = 0.05;
};

/// What surrounds one log, one value per sample of the command.
struct LogInput {
  double rate_hz = 100;
  std::vector<double> command_kpa;  // linear between samples
  std::vector<double> temperature_c;
  std::vector<double> supply_kpa;
  // Run-to-run variation (variation.h).
  double gain = 1, offset_mm = 0;
  std::size_t unrecorded = 0;  // first samples, before the recording begins
  // Closed loop: a controller follows the reference from the first recorded sample on. Its sensor adds
  // `noise_mm`, one value per recorded sample.
  std::vector<double> reference_mm, noise_mm;
};

struct LogOutput {
  std::vector<double> command_kpa;      // as played
  std::vector<double> pressure_kpa;     // true pressure at the actuator
  std::vector<double> displacement_mm;  // before noise and quantisation
};

/// Simulates the logs of one campaign in order. Every log starts at rest; the largest load so far, age and
/// drift run on from log to log. `step_s` is the integration step; it divides the sample period.
std::vector<LogOutput> simulate(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                                std::uint64_t seed, double step_s = 0.0005);

/// Somebody holds the sensor's target at known positions, one after the other, and reads.
struct GaugeWork {
  double placing_mm = 0.01;  // standard deviation of where the target really is
  double every_s = 20;       // from one position to the next
  double rate_hz = 100;
  std::size_t samples = 200;  // that are averaged at each position
};

/// The samples of each position, before noise and quantisation. `start_s` is the campaign's time by then:
/// drift, disturbances and wrong samples go on.
std::vector<std::vector<double>> held_at(const Effects& effects, const std::vector<double>& positions_mm,
                                         double start_s, std::uint64_t seed, const GaugeWork& work);

/// Removes the unrecorded samples of a log.
void drop_unrecorded(LogInput& in, LogOutput& out);

/// The largest displacement of the actuator without effects, when the pressure rises to `pressure_kpa` and
/// falls again.
double span_mm(const Base& base, double pressure_kpa);

/// White noise; deterministic in the seed.
std::vector<double> noise(std::size_t samples, double rms, std::uint64_t seed);
double quantised(double value, double step);

/// Noise, then quantisation; deterministic in the seed.
std::vector<double> measured(const std::vector<double>& clean, double rms, double step, std::uint64_t seed);

const std::vector<std::string>& library_ids();
const std::vector<std::string>& outside_ids();

/// An effect's numbers at amplitude 0 < s <= 1 (1: the largest that is physical), the rest drawn by seed.
/// `span_mm` and `campaign_s` are the campaign's displacement span and duration.
Effect draw_effect(const std::string& id, double s, std::uint64_t seed, double span_mm, double campaign_s);

}  // namespace blind
