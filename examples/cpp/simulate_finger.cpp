// Simulates a finger. `simulate_finger MODEL.yaml` prints time, pressure and displacement as CSV.

#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <vector>

#include <softgrip/model.h>

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "usage: simulate_finger MODEL.yaml\n");
    return 2;
  }
  const softgrip::Model model = softgrip::Model::load(arguments[1]);

  // Computes the pressure command: 20 s at 100 Hz of a sine from 0 to 60 kPa with a period of 5 s.
  std::vector<double> time_s, pressure_kpa;
  for (int i = 0; i <= 2000; ++i) {
    time_s.push_back(i / 100.0);
    pressure_kpa.push_back(30 - 30 * std::cos(2 * std::numbers::pi * 0.2 * time_s.back()));
  }
  const std::vector<double> displacement = model.simulate(time_s, pressure_kpa);

  std::printf("time_s,pressure_command_kpa,displacement_%s\n", name_of(model.unit()).c_str());
  for (std::size_t i = 0; i < time_s.size(); ++i)
    std::printf("%.2f,%.4f,%.5f\n", time_s[i], pressure_kpa[i], displacement[i]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "simulate_finger: %s\n", error.what());
  return 1;
}
