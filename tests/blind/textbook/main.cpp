// textbook-world: writes the logs of one world of textbook physics, and its truth elsewhere.
//
//   textbook-world --seed N --out DIR --truth FILE [--make NAME] [--cause ID[,ID...]] [--strength X] [--poor]
//                  [--pressure] [--no-temperature] [--no-supply]
//   textbook-world --list | --probe flow|rest|loops|creep
//
// Without --make the seed chooses. A strength is the excess error over the noise of 0.04 mm, per cause.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "world.h"

namespace {

constexpr double noise_mm = 0.04, step_mm = 0.01, pressure_noise_kpa = 0.05, supply_noise_kpa = 0.3,
                 temperature_noise_c = 0.05;

struct Arguments {
  std::uint64_t seed = 1;
  std::string out, truth, make, cause, probe;
  double strength = 8;
  bool poor = false, pressure = false, temperature = true, supply = true, list = false;
};

Arguments arguments(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string key = argv[i];
    bool flag = true;
    if (key == "--poor")
      a.poor = true;
    else if (key == "--pressure")
      a.pressure = true;
    else if (key == "--no-temperature")
      a.temperature = false;
    else if (key == "--no-supply")
      a.supply = false;
    else if (key == "--list")
      a.list = true;
    else
      flag = false;
    if (flag) continue;
    if (i + 1 >= argc) throw std::invalid_argument("no value for " + key);
    const std::string value = argv[++i];
    if (key == "--seed")
      a.seed = std::stoull(value);
    else if (key == "--out")
      a.out = value;
    else if (key == "--truth")
      a.truth = value;
    else if (key == "--make")
      a.make = value;
    else if (key == "--cause")
      a.cause = value;
    else if (key == "--strength")
      a.strength = std::stod(value);
    else if (key == "--probe")
      a.probe = value;
    else
      throw std::invalid_argument("unknown option " + key);
  }
  return a;
}

void probe_flow() {
  std::puts("ratio,flow");
  for (int i = 0; i <= 100; ++i)
    std::printf("%.2f,%.12g\n", i / 100.0, textbook::flow_dm3_s(0.01, 0.3, 300, 3.0 * i));
}

void probe_rest() {
  std::puts("time_s,air_kpa_dm3");
  textbook::Valve valve({});
  valve.set(180, 120, true);
  for (int i = 0; i <= 4000; ++i) {
    if (i % 400 == 0) std::printf("%.4f,%.12g\n", i * 0.00025, valve.air_kpa_dm3());
    valve.step(40, 200, 0.00025);
  }
}

// Up to 55, a minor loop 20 -> 40 -> 20 on the way down, then on: the loop must leave no trace.
void probe_loops() {
  std::puts("make,place,displacement_mm");
  for (const char* make : {"play", "maxwell_slip", "preisach"}) {
    for (const bool minor : {false, true}) {
      textbook::FingerNumbers numbers = textbook::draw_finger(make, 1);
      numbers.creep = 0;
      textbook::Finger finger(numbers);
      double p = 0, y = 0;
      const auto walk = [&](double to) {
        const double from = p;
        for (int i = 1; i <= 400; ++i) y = finger.step(p = from + (to - from) * i / 400, 0.002);
      };
      walk(55);
      walk(20);
      if (minor) {
        std::printf("%s,turn,%.12g\n", make, y);
        walk(40);
        std::printf("%s,inside,%.12g\n", make, y);
        walk(20);
        std::printf("%s,back,%.12g\n", make, y);
      }
      walk(5);
      std::printf("%s,%s,%.12g\n", make, minor ? "end" : "end_reference", y);
      walk(0);
      walk(40);
      std::printf("%s,%s,%.12g\n", make, minor ? "rising" : "rising_reference", y);
    }
  }
}

void probe_creep() {
  std::puts("make,time_s,displacement_mm");
  for (const std::string& make : textbook::makes()) {
    textbook::Finger finger(textbook::draw_finger(make, 1));
    double next = 0.02;
    for (int i = 1; i <= 500000; ++i) {
      const double y = finger.step(40, 0.002);
      if (i * 0.002 < next) continue;
      std::printf("%s,%.3f,%.12g\n", make.c_str(), i * 0.002, y);
      next *= 2;
    }
  }
}

void write_log(const std::string& path, const textbook::Log& log, const textbook::Answer& answer,
               const Arguments& a, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::ofstream file(path);
  file << "time_s,pressure_command_kpa,displacement_mm" << (a.pressure ? ",pressure_kpa" : "")
       << (a.temperature ? ",temperature_c" : "") << (a.supply ? ",supply_kpa" : "") << "\n";
  char cell[64];
  const auto put = [&](const char* format, double value) {
    std::snprintf(cell, sizeof cell, format, value);
    file << cell;
  };
  for (std::size_t k = 0; k < log.command_kpa.size(); ++k) {
    const double y = answer.displacement_mm[k] + noise_mm * normal(random);
    const double p = answer.pressure_kpa[k] + pressure_noise_kpa * normal(random);
    const double t = log.temperature_c[k] + temperature_noise_c * normal(random);
    const double s = log.supply_kpa[k] + supply_noise_kpa * normal(random);
    put("%.6f", static_cast<double>(k) / log.rate_hz);
    put(",%.6f", log.command_kpa[k]);
    put(",%.4f", step_mm * std::round(y / step_mm));
    if (a.pressure) put(",%.4f", p);
    if (a.temperature) put(",%.4f", t);
    if (a.supply) put(",%.3f", s);
    file << "\n";
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void write_truth(const Arguments& a, const textbook::World& world,
                 const std::map<std::string, textbook::Scaled>& hidden) {
  std::ofstream file(a.truth);
  file << "{\"seed\": " << a.seed << ", \"strength\": " << a.strength << ", \"noise_mm\": " << noise_mm
       << ", \"make\": \"" << world.finger.make << "\", \"span_mm\": " << world.finger.span_mm
       << ", \"own_physics\": [";
  const char* comma = "";
  for (const std::string& id : textbook::own_physics(world)) {
    file << comma << "\"" << id << "\"";
    comma = ", ";
  }
  file << "], \"effects\": {";
  comma = "";
  for (const auto& [id, scaled] : hidden) {
    file << comma << "\"" << id << "\": {\"excess_mm\": " << scaled.excess_mm
         << ", \"reachable\": " << (scaled.reachable ? "true" : "false") << ", \"parameters\": {";
    const char* inner = "";
    for (const auto& [name, value] : scaled.numbers) {
      file << inner << "\"" << name << "\": " << value;
      inner = ", ";
    }
    file << "}}";
    comma = ", ";
  }
  file << "}}\n";
  if (!file.flush()) throw std::runtime_error("cannot write " + a.truth);
}

int run(const Arguments& a) {
  if (a.list) {
    for (const auto& id : textbook::library_ids()) std::cout << id << "\n";
    return 0;
  }
  if (!a.probe.empty()) {
    if (a.probe == "flow")
      probe_flow();
    else if (a.probe == "rest")
      probe_rest();
    else if (a.probe == "loops")
      probe_loops();
    else if (a.probe == "creep")
      probe_creep();
    else
      throw std::invalid_argument("unknown probe " + a.probe);
    return 0;
  }
  if (a.out.empty() || a.truth.empty()) throw std::invalid_argument("--out and --truth are needed");
  const auto& makes = textbook::makes();
  const textbook::World world =
      textbook::draw_world(a.make.empty() ? makes[a.seed % makes.size()] : a.make, a.seed);
  std::map<std::string, textbook::Scaled> hidden;
  textbook::Effects effects;
  if (!a.cause.empty()) {
    const textbook::Excess excess(world, textbook::draw_campaign(a.seed, false), a.seed);
    std::stringstream ids(a.cause);
    for (std::string id; std::getline(ids, id, ',');) {
      hidden[id] = excess.scaled(id, a.strength * noise_mm);
      effects[id] = hidden[id].numbers;
    }
  }
  const auto logs = textbook::draw_campaign(a.seed, a.poor);
  const auto answers = textbook::simulate(world, effects, logs, a.seed);
  std::filesystem::create_directories(a.out);
  for (std::size_t i = 0; i < logs.size(); ++i)
    write_log(a.out + "/log_" + std::to_string(i + 1) + ".csv", logs[i], answers[i], a, a.seed * 37 + i);
  write_truth(a, world, hidden);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(arguments(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "textbook-world: " << error.what() << "\n";
    return 2;
  }
}
