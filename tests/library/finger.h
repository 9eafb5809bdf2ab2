#pragma once
// A model and signals for the tests of the library.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "library/include/softgrip/model.h"

namespace softgrip {

[[nodiscard]] inline Model bench_twin() {
  return Model::load(std::string(SOFTGRIP_SOURCE_DIR) + "/config/models/bench_twin.yaml");
}

/// A signal with its sample times.
struct Course {
  std::vector<double> time_s;
  std::vector<double> value;
};

/// Returns a sine signal that begins at `low`, rises to `high` and returns to `low`.
[[nodiscard]] inline Course sine(double low, double high, double frequency_hz, std::size_t samples,
                                 double step_s) {
  Course course;
  for (std::size_t i = 0; i < samples; ++i) {
    const double time_s = static_cast<double>(i) * step_s;
    course.time_s.push_back(time_s);
    const double phase = 2 * std::numbers::pi * frequency_hz * time_s;
    course.value.push_back(low + 0.5 * (high - low) * (1 - std::cos(phase)));
  }
  return course;
}

}  // namespace softgrip
