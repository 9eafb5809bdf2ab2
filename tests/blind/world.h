#pragma once
// Simulates a world that may contain a hidden effect. The simulation has its own model of the actuator and
// its own integration with a fine step. It links no code of the project. Its equations follow the definitions
// of the causes, not the code of the blocks.

#include <cstdint>
#include <string>
#include <vector>

#include "world_program.h"

namespace blind {

/// Parameters of the actuator without hidden effects. Pressures are in kPa, displacements in mm, times in s.
struct Base {
  double alpha = 0.35;           // mm/kPa
  double beta = 0.20;            // mm/kPa
  double gamma = 0.03;           // 1/kPa
  double eta = 0.05;             // 1/kPa
  double instantaneous = 0.003;  // 1/k0 in mm/kPa
  double fast_gain = 0.25, fast_tau = 0.4;
  double slow_gain = 0.056, slow_tau = 13.7;
};

using Effect = worlds::Numbers;
using worlds::Effects;
using LogInput = worlds::Log;
using LogOutput = worlds::Answer;
using worlds::drop_unrecorded;

struct Sensor {
  double noise_mm = 0.04;
  double step_mm = 0.01;
  double pressure_noise_kpa = 0.05;
};

/// Simulates the logs of one campaign in order. Every log starts at rest. The largest load, the age and the
/// drift of the finger continue from log to log. `step_s` is the integration step [s]; the sample period must
/// be a multiple of `step_s`.
std::vector<LogOutput> simulate(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                                std::uint64_t seed, double step_s = 0.0005);

/// Settings of a gauge check. An operator holds the target of the sensor at one known position after the
/// other. At each position, the operator averages the readings of the sensor.
struct GaugeWork {
  double placing_mm = 0.01;  // standard deviation of the true target position [mm]
  double every_s = 20;       // time between two positions of the gauge check [s]
  double rate_hz = 100;
  std::size_t samples = 200;  // number of readings to average at each position
};

/// Returns the readings at each position [mm], before noise and quantisation. `start_s` is the time in the
/// campaign at which the check begins. Drift, disturbances and wrong samples continue during the check.
std::vector<std::vector<double>> held_at(const Effects& effects, const std::vector<double>& positions_mm,
                                         double start_s, std::uint64_t seed, const GaugeWork& work);

/// Simulates the actuator without effects while the pressure rises to `pressure_kpa` and then falls. Returns
/// the largest displacement.
double span_mm(const Base& base, double pressure_kpa);

/// Returns white noise. The seed determines the values.
std::vector<double> noise(std::size_t samples, double rms, std::uint64_t seed);
double quantised(double value, double step);

/// Adds noise to the values and quantises them. The seed determines the noise.
std::vector<double> measured(const std::vector<double>& clean, double rms, double step, std::uint64_t seed);

const std::vector<std::string>& library_ids();
const std::vector<std::string>& outside_ids();

/// Returns the parameters of an effect. Amplitude `s` is between 0 and 1; 1 is the largest physical size. The
/// parameters that do not depend on the amplitude are drawn from the seed. `span_mm` and `campaign_s` are the
/// displacement span and the duration of the campaign.
Effect draw_effect(const std::string& id, double s, std::uint64_t seed, double span_mm, double campaign_s);

}  // namespace blind
