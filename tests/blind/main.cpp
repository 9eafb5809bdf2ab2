// blind-world writes the logs of one simulated world to a folder, and its true effects to a separate file.
//
//   blind-world --seed N --out DIR --truth FILE [--cause ID[,ID]] [--strength X] [--poor] [--pressure]
//               [--campaign N] [--zero-mm Z] [--warmer-c D] [--runs N] [--variation X] [--closed-loop]
//               [--command CSV ... --log FILE] [--gauge CSV --log FILE]
//
// DIR receives log_1.csv ... in the project's log format and no other file. With --command, the world plays
// the commands of these files after its campaign, in the order of the options. It writes only its response to
// the last of these commands, to the file of --log. With --campaign, the same finger is driven by different
// waveforms, with different noise. Z [mm] is added to every reading and D [degC] to every temperature. With
// --gauge, a simulated operator holds the target of the sensor at the positions in the first column of this
// file [mm]. This check takes place after the commands. The sensor readings are written next to the
// positions. --runs is the number of logs [3; 1 with --poor]. --variation is the strength of the run-to-run
// variation (variation.h) [0]; --list-runs prints the parameters of the varied runs. With --closed-loop, a
// controller plays the commands of all logs.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>

#include "strength.h"
#include "variation.h"
#include "waveforms.h"
#include "world.h"

namespace {

struct Arguments {
  std::uint64_t seed = 1, campaign = 0;
  std::string out, truth, cause, log, gauge;
  std::vector<std::string> commands;
  double strength = 8, zero_mm = 0, warmer_c = 0, variation = 0;
  std::size_t runs = 3;
  bool pressure = false, list = false, list_runs = false, closed_loop = false;
};

Arguments arguments(int argc, char** argv) {
  Arguments a;
  worlds::Options options;
  options.flag("--poor", [&a] { a.runs = 1; });
  options.flag("--closed-loop", a.closed_loop);
  options.flag("--pressure", a.pressure);
  options.flag("--list-runs", a.list_runs);
  options.flag("--list", a.list);
  options.value("--seed", a.seed);
  options.value("--out", a.out);
  options.value("--truth", a.truth);
  options.value("--cause", a.cause);
  options.value("--strength", a.strength);
  options.value("--campaign", a.campaign);
  options.value("--runs", a.runs);
  options.value("--variation", a.variation);
  options.value("--zero-mm", a.zero_mm);
  options.value("--warmer-c", a.warmer_c);
  options.value("--command", [&a](const std::string& path) { a.commands.push_back(path); });
  options.value("--log", a.log);
  options.value("--gauge", a.gauge);
  options.read(argc, argv);
  return a;
}

blind::Base scattered(std::uint64_t seed) {
  blind::Base base;
  std::mt19937_64 random(seed * 104729 + 3);
  std::normal_distribution<double> percent(0, 0.04);
  for (double* value : {&base.alpha, &base.beta, &base.gamma, &base.eta, &base.instantaneous, &base.fast_gain,
                        &base.fast_tau, &base.slow_gain, &base.slow_tau})
    *value *= 1 + percent(random);
  return base;
}

// Converts the commands of a log to references of a controller, for a log in closed loop. `zero_mm` is the
// zero offset of the controller's sensor.
void close_loop(blind::LogInput& log, const blind::Sensor& sensor, double mm_per_kpa, double zero_mm,
                std::uint64_t seed) {
  log.offset_mm += zero_mm;
  log.noise_mm = blind::noise(log.command_kpa.size() - log.unrecorded, sensor.noise_mm, seed);
  for (const double u : log.command_kpa) log.reference_mm.push_back(mm_per_kpa * u);
}

void write_log(const std::string& path, const blind::LogInput& in, const blind::LogOutput& out,
               const blind::Sensor& sensor, bool with_pressure, std::uint64_t seed) {
  const auto y = blind::measured(out.displacement_mm, sensor.noise_mm, sensor.step_mm, seed);
  const auto p = blind::measured(out.pressure_kpa, sensor.pressure_noise_kpa, 0, seed + 1);
  std::ofstream file(path);
  file << "time_s,pressure_command_kpa,displacement_mm" << (with_pressure ? ",pressure_kpa" : "")
       << ",temperature_c,supply_kpa\n";
  char row[256];
  for (std::size_t k = 0; k < y.size(); ++k) {
    std::snprintf(row, sizeof row, "%.6f,%.6f,%.4f", static_cast<double>(k) / in.rate_hz, out.command_kpa[k],
                  y[k]);
    file << row;
    if (with_pressure) {
      std::snprintf(row, sizeof row, ",%.4f", p[k]);
      file << row;
    }
    std::snprintf(row, sizeof row, ",%.4f,%.3f\n", in.temperature_c[k], in.supply_kpa[k]);
    file << row;
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

std::vector<double> read_command(const std::string& path, double& rate_hz) {
  std::ifstream file(path);
  std::string line;
  std::vector<double> time, command;
  std::getline(file, line);
  while (std::getline(file, line)) {
    double t = 0, u = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf", &t, &u) != 2) throw std::runtime_error("bad row in " + path);
    time.push_back(t);
    command.push_back(u);
  }
  if (time.size() < 2) throw std::runtime_error("too few rows in " + path);
  rate_hz = 1 / (time[1] - time[0]);
  return command;
}

std::vector<double> read_positions(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::vector<double> positions;
  std::getline(file, line);
  if (line.rfind("gauge_mm", 0) != 0) throw std::runtime_error("no column gauge_mm in " + path);
  while (std::getline(file, line)) {
    double position = 0;
    if (std::sscanf(line.c_str(), "%lf", &position) != 1) throw std::runtime_error("bad row in " + path);
    positions.push_back(position);
  }
  if (positions.empty()) throw std::runtime_error("no positions in " + path);
  return positions;
}

void write_gauge(const std::string& path, const std::vector<double>& positions,
                 const std::vector<std::vector<double>>& clean, const blind::Sensor& sensor,
                 std::uint64_t seed) {
  std::ofstream file(path);
  file << "gauge_mm,displacement_mm,samples\n";
  char row[128];
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const auto samples = blind::measured(clean[k], sensor.noise_mm, sensor.step_mm, seed + k);
    double mean = 0;
    for (const double y : samples) mean += y / static_cast<double>(samples.size());
    std::snprintf(row, sizeof row, "%.6g,%.4f,%zu\n", positions[k], mean, samples.size());
    file << row;
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void write_truth(const std::string& path, const Arguments& a,
                 const std::map<std::string, blind::Scaled>& hidden, double change_mm,
                 const blind::Sensor& sensor) {
  std::ofstream file(path);
  // Write the true values with all digits. With six digits, the rounding error of a frequency would exceed
  // the error of an estimate from ten minutes of logs.
  file.precision(std::numeric_limits<double>::max_digits10);
  file << "{\"seed\": " << a.seed << ", \"strength\": " << a.strength << ", \"noise_mm\": " << sensor.noise_mm
       << ", ";
  worlds::write_effects(file, hidden, change_mm);
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

int run(const Arguments& a) {
  if (a.list) {
    for (const auto& id : blind::library_ids()) std::cout << id << "\n";
    for (const auto& id : blind::outside_ids()) std::cout << id << "\n";
    return 0;
  }
  const std::uint64_t drive_seed = a.seed + 1000003 * a.campaign;
  if (a.list_runs) {
    variation::list_runs(std::cout, a.variation, drive_seed, a.runs);
    return 0;
  }
  if (a.commands.empty() && a.gauge.empty() && (a.out.empty() || a.truth.empty()))
    throw std::invalid_argument("the options --out and --truth are required");
  const blind::Base base = scattered(a.seed);
  const blind::Sensor sensor;
  constexpr double working_kpa = 60;
  const double span_mm = blind::span_mm(base, working_kpa);
  std::vector<blind::LogInput> logs = blind::draw_campaign({drive_seed, a.runs, a.variation, span_mm});
  blind::Effects effects;
  std::map<std::string, blind::Scaled> scaled;
  for (const std::string& id : worlds::ids_in(a.cause)) {
    const auto rich = blind::draw_campaign({drive_seed});
    scaled[id] = blind::scale_to(id, a.strength * sensor.noise_mm, base, rich, a.seed);
    effects[id] = scaled[id].numbers;
  }
  for (const std::string& path : a.commands) {
    double rate_hz = 0;
    auto command = read_command(path, rate_hz);
    logs.push_back(blind::surrounded(std::move(command), rate_hz, worlds::duration_s(logs), a.seed));
  }
  if (!a.gauge.empty()) {
    const auto positions = read_positions(a.gauge);
    const auto clean = blind::held_at(effects, positions, worlds::duration_s(logs), a.seed, {});
    write_gauge(a.log, positions, clean, sensor, a.seed * 31 + 500000);
    return 0;
  }
  if (!a.commands.empty()) {
    const auto out = blind::simulate(base, effects, logs, a.seed);
    write_log(a.log, logs.back(), out.back(), sensor, a.pressure, a.seed * 31 + 1000 + 2 * a.commands.size());
    return 0;
  }
  std::filesystem::create_directories(a.out);
  const auto noise_seed = [&](std::size_t i) { return drive_seed * 31 + i * 2; };
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (double& t : logs[i].temperature_c) t += a.warmer_c;
    if (a.closed_loop) close_loop(logs[i], sensor, span_mm / working_kpa, a.zero_mm, noise_seed(i));
  }
  auto outputs = blind::simulate(base, effects, logs, a.seed);
  const double change_mm = worlds::recorded_change_mm(logs, outputs, blind::simulate(base, {}, logs, a.seed));
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (!a.closed_loop)
      for (double& y : outputs[i].displacement_mm) y += a.zero_mm;
    blind::drop_unrecorded(logs[i], outputs[i]);
    write_log(a.out + "/log_" + std::to_string(i + 1) + ".csv", logs[i], outputs[i], sensor, a.pressure,
              noise_seed(i));
  }
  write_truth(a.truth, a, scaled, change_mm, sensor);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return worlds::exit_code_of("blind-world", [&] { return run(arguments(argc, argv)); });
}
