#include "model/signals.h"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace softgrip::model {
namespace {

// One rise of the pressure from 0 to a peak, and back to 0.
struct Pulse {
  double peak_kpa;
  double duration_s;
};
// One corner of a piecewise-linear signal.
struct Corner {
  double time_s;
  double kpa;
};

// Amplitudes and rates of the pulses vary independently. The rates are 10 to 30 kPa/s in the first cycle and
// 9 to 28 kPa/s in the second cycle. Therefore, the data can separate hysteresis, which depends on the
// amplitude, from creep, which depends on time.
constexpr std::array first_cycle{Pulse{60, 10}, Pulse{40, 5}, Pulse{50, 4}, Pulse{20, 4}, Pulse{30, 2}};
constexpr std::array second_cycle{Pulse{50, 8}, Pulse{25, 4}, Pulse{60, 6}, Pulse{35, 2.5}, Pulse{15, 3.5}};
constexpr int cycles = 2;

// Each change of the pressure is a ramp of 0.2 s. With jumps, the simulated pressure would depend on the
// sampling rate.
constexpr double ramp_s = 0.2;
constexpr std::array steps_corners{Corner{0, 0},
                                   Corner{1, 0},  //
                                   Corner{1 + ramp_s, 12},
                                   Corner{7, 12},
                                   Corner{7 + ramp_s, 24},
                                   Corner{13, 24},
                                   Corner{13 + ramp_s, 36},
                                   Corner{19, 36},
                                   Corner{19 + ramp_s, 48},
                                   Corner{25, 48},
                                   Corner{25 + ramp_s, 60},
                                   Corner{31, 60},
                                   Corner{31 + ramp_s, 48},
                                   Corner{37, 48},
                                   Corner{37 + ramp_s, 36},
                                   Corner{43, 36},
                                   Corner{43 + ramp_s, 24},
                                   Corner{49, 24},
                                   Corner{49 + ramp_s, 12},
                                   Corner{55, 12},
                                   Corner{55 + ramp_s, 0},
                                   Corner{65, 0}};
constexpr std::array hold_corners{Corner{0, 0}, Corner{1, 50}, Corner{61, 50}, Corner{62, 0}, Corner{90, 0}};

double cycle_s(std::span<const Pulse> pulses) {
  double sum = 0;
  for (const Pulse& pulse : pulses) sum += pulse.duration_s;
  return sum;
}

double triangle(double phase) {
  return phase < 0.5 ? 2 * phase : 2 - 2 * phase;
}
double raised_cosine(double phase) {
  return 0.5 * (1 - std::cos(2 * std::numbers::pi * phase));
}

double pulses_kpa(std::span<const Pulse> pulses, double (*shape)(double), double time_s) {
  double rest = std::fmod(time_s, cycle_s(pulses));
  for (const Pulse& pulse : pulses) {
    if (rest < pulse.duration_s) return pulse.peak_kpa * shape(rest / pulse.duration_s);
    rest -= pulse.duration_s;
  }
  return 0;
}

double corners_kpa(std::span<const Corner> corners, double time_s) {
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Corner& a = corners[i - 1];
    const Corner& b = corners[i];
    if (time_s < b.time_s) return a.kpa + (b.kpa - a.kpa) * ((time_s - a.time_s) / (b.time_s - a.time_s));
  }
  return corners.back().kpa;
}

}  // namespace

double duration_s(SignalName signal) {
  switch (signal) {
    case SignalName::tp1:
    case SignalName::sp1:
      return cycles * cycle_s(first_cycle);
    case SignalName::tp2:
    case SignalName::sp2:
      return cycles * cycle_s(second_cycle);
    case SignalName::steps:
      return steps_corners.back().time_s;
    case SignalName::hold:
      return hold_corners.back().time_s;
  }
  return 0;
}

double value_kpa(SignalName signal, double time_s) {
  if (!(time_s > 0 && time_s < duration_s(signal))) return 0;
  switch (signal) {
    case SignalName::tp1:
      return pulses_kpa(first_cycle, triangle, time_s);
    case SignalName::tp2:
      return pulses_kpa(second_cycle, triangle, time_s);
    case SignalName::sp1:
      return pulses_kpa(first_cycle, raised_cosine, time_s);
    case SignalName::sp2:
      return pulses_kpa(second_cycle, raised_cosine, time_s);
    case SignalName::steps:
      return corners_kpa(steps_corners, time_s);
    case SignalName::hold:
      return corners_kpa(hold_corners, time_s);
  }
  return 0;
}

}  // namespace softgrip::model
