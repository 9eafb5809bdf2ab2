// textbook-world simulates a world with textbook equations. It writes the logs to a folder and the true
// effects to a separate file.
//
//   textbook-world --seed N --out DIR --truth FILE [--make NAME] [--cause ID[,ID...]] [--strength X] [--poor]
//                  [--campaign N] [--pressure] [--no-temperature] [--no-supply] [--zero-mm Z] [--warmer-c D]
//                  [--runs N] [--variation X] [--closed-loop] [--rate-hz R]
//   textbook-world --list | --makes | --probe flow|rest|hold|loops|relays|span|creep
//
// Without --make, the seed chooses the make. The strength of a cause is its unexplained error (strength.h)
// divided by the noise of 0.04 mm. With --campaign, the same finger and valve are driven by different
// waveforms, with different noise. Z [mm] is added to every reading and D [degC] to every temperature. --runs
// is the number of logs [3; 1 with --poor]. --variation is the strength of the run-to-run variation
// (variation.h) [0]; with a variation the sample rate of each log is also drawn. With --closed-loop a
// controller plays the commands of all logs.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>

#include "own_physics.h"
#include "probes.h"
#include "strength.h"
#include "world.h"

namespace {

constexpr double noise_mm = 0.04, step_mm = 0.01, pressure_noise_kpa = 0.05, supply_noise_kpa = 0.3,
                 temperature_noise_c = 0.05;
// Smallest displacement change that a diagnosis can detect, for one mechanism of the finger or the valve. A
// campaign has 15,000 samples, so the noise of 0.04 mm hides only much smaller changes.
constexpr double visible_mm = noise_mm / 4;

struct Arguments {
  std::uint64_t seed = 1, campaign = 0;
  std::string out, truth, make, cause, probe;
  double strength = 8, zero_mm = 0, warmer_c = 0, rate_hz = 100, variation = 0;
  std::size_t runs = 3;
  bool pressure = false, temperature = true, supply = true, list = false, makes = false, closed_loop = false;
};

// Reads the sample rate from the command line. The sample time must be a multiple of the time step of the
// valve simulation.
double rate(const std::string& value) {
  const double rate_hz = std::stod(value);
  if (rate_hz != 50 && rate_hz != 100 && rate_hz != 200 && rate_hz != 400)
    throw std::invalid_argument("--rate-hz must be one of 50, 100, 200, 400");
  return rate_hz;
}

Arguments arguments(int argc, char** argv) {
  Arguments a;
  worlds::Options options;
  options.flag("--poor", [&a] { a.runs = 1; });
  options.flag("--closed-loop", a.closed_loop);
  options.flag("--pressure", a.pressure);
  options.flag("--no-temperature", a.temperature, false);
  options.flag("--no-supply", a.supply, false);
  options.flag("--list", a.list);
  options.flag("--makes", a.makes);
  options.value("--seed", a.seed);
  options.value("--campaign", a.campaign);
  options.value("--out", a.out);
  options.value("--truth", a.truth);
  options.value("--make", a.make);
  options.value("--cause", a.cause);
  options.value("--strength", a.strength);
  options.value("--runs", a.runs);
  options.value("--variation", a.variation);
  options.value("--zero-mm", a.zero_mm);
  options.value("--warmer-c", a.warmer_c);
  options.value("--rate-hz", [&a](const std::string& text) { a.rate_hz = rate(text); });
  options.value("--probe", a.probe);
  options.read(argc, argv);
  return a;
}

// Generates the noise of the sensors for one sample after the other.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}
  struct Sample {
    double displacement_mm, pressure_kpa, temperature_c, supply_kpa;
  };
  Sample next() {
    const double y = noise_mm * normal_(random_), p = pressure_noise_kpa * normal_(random_);
    const double t = temperature_noise_c * normal_(random_), s = supply_noise_kpa * normal_(random_);
    return {y, p, t, s};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{0, 1};
};

// Converts the commands of a log to references of a controller, for a log in closed loop. The controller and
// the log read sensors with the same noise amplitude.
void close_loop(textbook::Log& log, const textbook::World& world, double zero_mm, std::uint64_t seed) {
  Noise noise(seed);
  for (std::size_t k = log.unrecorded; k < log.command_kpa.size(); ++k)
    log.noise_mm.push_back(zero_mm + noise.next().displacement_mm);
  for (const double u : log.command_kpa)
    log.reference_mm.push_back(world.finger.span_mm / textbook::working_kpa * u);
}

void write_log(const std::string& path, const textbook::Log& log, const textbook::Answer& answer,
               const Arguments& a, std::uint64_t seed) {
  Noise noise(seed);
  std::ofstream file(path);
  file << "time_s,pressure_command_kpa,displacement_mm" << (a.pressure ? ",pressure_kpa" : "")
       << (a.temperature ? ",temperature_c" : "") << (a.supply ? ",supply_kpa" : "") << "\n";
  char cell[64];
  const auto put = [&](const char* format, double value) {
    std::snprintf(cell, sizeof cell, format, value);
    file << cell;
  };
  for (std::size_t k = 0; k < log.command_kpa.size(); ++k) {
    const Noise::Sample added = noise.next();
    const double y = answer.displacement_mm[k] + a.zero_mm + added.displacement_mm;
    const double p = answer.pressure_kpa[k] + added.pressure_kpa;
    const double t = log.temperature_c[k] + added.temperature_c;
    const double s = log.supply_kpa[k] + added.supply_kpa;
    put("%.6f", static_cast<double>(k) / log.rate_hz);
    put(",%.6f", answer.command_kpa[k]);
    put(",%.4f", step_mm * std::round(y / step_mm));
    if (a.pressure) put(",%.4f", p);
    if (a.temperature) put(",%.4f", t);
    if (a.supply) put(",%.3f", s);
    file << "\n";
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void write_truth(const Arguments& a, const textbook::World& world, const std::map<std::string, double>& own,
                 const std::map<std::string, textbook::Scaled>& hidden, double change_mm) {
  std::ofstream file(a.truth);
  // Write the true values with all digits. With six digits, the rounding error of a frequency would exceed
  // the error of an estimate from ten minutes of logs.
  file.precision(std::numeric_limits<double>::max_digits10);
  file << "{\"seed\": " << a.seed << ", \"strength\": " << a.strength << ", \"noise_mm\": " << noise_mm
       << ", \"make\": \"" << world.finger.make << "\", \"span_mm\": " << world.finger.span_mm
       << ", \"own_physics_mm\": {";
  const char* comma = "";
  for (const auto& [id, size_mm] : own) {
    file << comma << "\"" << id << "\": " << size_mm;
    comma = ", ";
  }
  file << "}, ";
  worlds::write_effects(file, hidden, change_mm);
  if (!file.flush()) throw std::runtime_error("cannot write " + a.truth);
}

int run(const Arguments& a) {
  if (a.makes) {
    for (const auto& make : textbook::makes()) std::cout << make << "\n";
    return 0;
  }
  if (a.list) {
    for (const auto& id : textbook::library_ids()) std::cout << id << "\n";
    return 0;
  }
  if (!a.probe.empty()) {
    textbook::probe(a.probe);
    return 0;
  }
  if (a.out.empty() || a.truth.empty())
    throw std::invalid_argument("the options --out and --truth are required");
  const auto& makes = textbook::makes();
  const textbook::World world =
      textbook::draw_world(a.make.empty() ? makes[a.seed % makes.size()] : a.make, a.seed);
  const std::uint64_t drive_seed = a.seed + 1000003 * a.campaign;
  const auto whole = textbook::draw_campaign({drive_seed, 3, a.rate_hz});
  std::map<std::string, textbook::Scaled> hidden;
  textbook::Effects effects;
  if (!a.cause.empty()) {
    const textbook::Excess excess(world, whole, a.seed);
    for (const std::string& id : worlds::ids_in(a.cause)) {
      hidden[id] = excess.scaled(id, a.strength * noise_mm);
      effects[id] = hidden[id].numbers;
    }
  }
  auto logs = textbook::draw_campaign({drive_seed, a.runs, a.rate_hz, a.variation, world.finger.span_mm});
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (double& t : logs[i].temperature_c) t += a.warmer_c;
    if (a.closed_loop) close_loop(logs[i], world, a.zero_mm, drive_seed * 37 + i);
  }
  auto answers = textbook::simulate(world, effects, logs, a.seed);
  const double change_mm =
      worlds::recorded_change_mm(logs, answers, textbook::simulate(world, {}, logs, a.seed));
  std::filesystem::create_directories(a.out);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    textbook::drop_unrecorded(logs[i], answers[i]);
    write_log(a.out + "/log_" + std::to_string(i + 1) + ".csv", logs[i], answers[i], a, drive_seed * 37 + i);
  }
  write_truth(a, world, textbook::own_physics(world, whole, a.seed, visible_mm), hidden, change_mm);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return worlds::exit_code_of("textbook-world", [&] { return run(arguments(argc, argv)); });
}
