#include "variation.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace variation {
namespace {

constexpr double ramp_s = 1;
constexpr double proportional = 0.4,
                 integral_per_s = 0.8;  // integral gain of the controller times the gain of the finger [1/s]

std::mt19937_64 generator(std::uint64_t seed, std::size_t run) {
  return std::mt19937_64((seed * 0x9E3779B97F4A7C15ULL) ^ (run * 0xBF58476D1CE4E5B9ULL + 77));
}

}  // namespace

Run draw_run(double strength, std::uint64_t seed, std::size_t run) {
  Run drawn;
  if (strength <= 0) return drawn;
  auto random = generator(seed, run + 1);
  std::normal_distribution<double> normal(0, strength);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  drawn.offset_share = offset_share * normal(random);
  drawn.gain = 1 + gain_share * normal(random);
  drawn.warmer_c = temperature_c * normal(random);
  drawn.supply = 1 + supply_share * normal(random);
  drawn.amplitude = 1 - std::min(0.5, 0.2 * strength * between(0, 1));
  constexpr double rates_hz[] = {50, 100, 200};
  drawn.rate_hz = rates_hz[std::uniform_int_distribution<int>(0, 2)(random)];
  drawn.pulse_share = std::min(1.0, strength * between(0.2, 0.8));
  drawn.pulse_s = between(2, 15);
  drawn.rest_s = between(2, 20);
  return drawn;
}

void list_runs(std::ostream& out, double strength, std::uint64_t seed, std::size_t runs) {
  out << "offset_share,gain,warmer_c,supply,amplitude,rate_hz,pulse_share,pulse_s,rest_s\n";
  out.precision(12);
  for (std::size_t i = 0; i < runs; ++i) {
    const Run run = draw_run(strength, seed, i);
    const char* comma = "";
    for (const double value : {run.offset_share, run.gain, run.warmer_c, run.supply, run.amplitude,
                               run.rate_hz, run.pulse_share, run.pulse_s, run.rest_s}) {
      out << comma << value;
      comma = ",";
    }
    out << "\n";
  }
}

std::size_t first_kind(double strength, std::uint64_t seed, std::size_t kinds) {
  if (strength <= 0) return 0;
  auto random = generator(seed, 0);
  return std::uniform_int_distribution<std::size_t>(0, kinds - 1)(random);
}

std::vector<double> resampled(const std::vector<double>& values, double from_hz, double to_hz) {
  if (from_hz == to_hz) return values;
  const double length = static_cast<double>(values.size() - 1) / from_hz;
  std::vector<double> out;
  const auto count = static_cast<std::size_t>(length * to_hz + 1e-9);
  for (std::size_t k = 0; k <= count; ++k) {
    const double place = static_cast<double>(k) * from_hz / to_hz;
    const std::size_t low = std::min(static_cast<std::size_t>(place), values.size() - 1);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    const double part = place - static_cast<double>(low);
    out.push_back((1 - part) * values[low] + part * values[high]);
  }
  return out;
}

std::vector<double> pulse(const Run& run, double working_kpa, double rate_hz) {
  std::vector<double> out;
  if (run.pulse_share <= 0) return out;
  const double level = run.pulse_share * working_kpa;
  const double length = 2 * ramp_s + run.pulse_s + run.rest_s;
  for (std::size_t k = 0; k < static_cast<std::size_t>(length * rate_hz); ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    const double up = t / ramp_s, down = (2 * ramp_s + run.pulse_s - t) / ramp_s;
    out.push_back(level * std::clamp(std::min(up, down), 0.0, 1.0));
  }
  return out;
}

double Controller::step(double reference_mm, double reading_mm) {
  const double missing_kpa = (reference_mm - reading_mm) / mm_per_kpa_;
  const double next_kpa = integral_kpa_ + integral_per_s * missing_kpa / rate_hz_;
  const double wanted = reference_mm / mm_per_kpa_ + proportional * missing_kpa + next_kpa;
  const double command = std::clamp(wanted, 0.0, most_kpa_);
  if (command == wanted || std::abs(next_kpa) < std::abs(integral_kpa_)) integral_kpa_ = next_kpa;
  return command;
}

}  // namespace variation
