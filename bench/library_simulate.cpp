// Measures Model::simulate(). `library_simulate MODEL.yaml SAMPLES CALLS` prints the duration of each call
// [ns]. bench/python_library.py compares this duration with the duration of the same call from Python.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <softgrip/model.h>

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const softgrip::Model model = softgrip::Model::load(arguments[1]);
  std::vector<double> time_s, pressure_kpa;
  for (int i = 0; i < std::atoi(arguments[2]); ++i) {
    time_s.push_back(i / 100.0);
    pressure_kpa.push_back(20 - 20 * std::cos(2 * std::numbers::pi * 0.1 * time_s.back()));
  }
  double sum = 0;
  for (int i = 0; i < std::atoi(arguments[3]); ++i) {
    const auto began = std::chrono::steady_clock::now();
    const std::vector<double> moved = model.simulate(time_s, pressure_kpa);
    const auto ended = std::chrono::steady_clock::now();
    sum += moved.back();
    std::printf("%lld\n", static_cast<long long>((ended - began).count()));
  }
  return sum > 0 ? 0 : 1;
}
