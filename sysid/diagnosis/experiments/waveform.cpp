#include "sysid/diagnosis/experiments/waveform.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace softgrip::sysid {
namespace {

/// Highest slew rate of a waveform, as a share of the slew limit of the rig. At the slew limit itself, the
/// rig would change the shape of the command.
constexpr double slew_share = 0.9;
/// Times at zero pressure before (`lead_s`) and after (`tail_s`) a waveform [s]. With these times, the log
/// contains the complete first and last motion.
constexpr double lead_s = 1;
constexpr double tail_s = 5;

/// Builds a waveform corner by corner. The pressure of a corner is stated as a share of the largest pressure.
class Pen {
 public:
  Pen(std::string name, std::string about, const RigLimits& limits) : limits_(limits) {
    waveform_.name = std::move(name);
    waveform_.about = std::move(about);
    waveform_.corners.push_back({0, 0});
    hold(lead_s);
  }
  Pen& to(double level, double seconds) {
    const double target = level * limits_.pressure_max_kpa;
    const Corner last = waveform_.corners.back();
    const double fastest_s = std::abs(target - last.pressure_kpa) / (slew_share * limits_.slew_kpa_per_s);
    // Times are rounded up to 1 ms, so that the file is readable and most rigs can execute the times exactly.
    const double taken_s = std::ceil(1000 * std::max(seconds, fastest_s) - 1e-9) / 1000;
    waveform_.corners.push_back({round_ms(last.time_s + std::max(taken_s, 0.001)), target});
    return *this;
  }
  Pen& jump(double level) { return to(level, 0); }
  Pen& hold(double seconds) {
    const Corner last = waveform_.corners.back();
    waveform_.corners.push_back({round_ms(last.time_s + seconds), last.pressure_kpa});
    return *this;
  }
  Pen& triangles(double level, double half_s, int count) {
    for (int i = 0; i < count; ++i) to(level, half_s).to(0, half_s);
    return *this;
  }
  Waveform done() {
    hold(tail_s);
    return std::move(waveform_);
  }

 private:
  static double round_ms(double time_s) { return std::round(1000 * time_s) / 1000; }
  const RigLimits& limits_;
  Waveform waveform_;
};

Waveform rest_and_repeat(const RigLimits& limits) {
  Pen pen("rest_and_repeat",
          "equal loads, repeated after rests; creep recovers during a rest, but softening does not", limits);
  pen.triangles(0.55, 2.5, 2).hold(20).triangles(0.55, 2.5, 1);
  pen.triangles(1, 2.5, 2).hold(40).triangles(1, 2.5, 1).triangles(0.55, 2.5, 2);
  return pen.done();
}

Waveform three_rates(const RigLimits& limits) {
  Pen pen("triangles_three_rates", "strokes of one amplitude at three rates of pressure, over two decades",
          limits);
  pen.triangles(0.9, 0.3, 6).hold(3).triangles(0.9, 3, 3).hold(3).triangles(0.9, 30, 1);
  return pen.done();
}

Waveform staircase(const RigLimits& limits) {
  Pen pen("staircase_with_holds", "pressure steps up and down with holds", limits);
  for (const double level : {0.2, 0.4, 0.6, 0.8, 1.0, 0.8, 0.6, 0.4, 0.2, 0.0}) pen.to(level, 0.3).hold(5);
  return pen.done();
}

Waveform minor_loops(const RigLimits& limits) {
  Pen pen("minor_loops", "small pressure loops inside large loops, for loading and unloading", limits);
  pen.to(1, 2);
  for (const double low : {0.7, 0.45, 0.2}) pen.to(low, 1).to(low + 0.25, 1).to(low, 1).to(1, 2);
  pen.to(0, 2);
  for (const double high : {0.35, 0.6, 0.85}) pen.to(high, 1).to(high - 0.25, 1).to(high, 1).to(0, 2);
  return pen.done();
}

Waveform amplitude_ladder(const RigLimits& limits) {
  Pen pen("amplitude_ladder", "triangles of rising and falling amplitude at one rate of pressure", limits);
  for (const double level : {0.15, 0.3, 0.45, 0.6, 0.8, 1.0, 0.8, 0.6, 0.45, 0.3, 0.15})
    pen.triangles(level, 3 * level, 1);
  return pen.done();
}

Waveform sharp_steps(const RigLimits& limits) {
  Pen pen("sharp_steps", "large and small pressure steps at the highest rate that the rig permits", limits);
  pen.jump(0.5).hold(3).jump(1).hold(3).jump(0.4).hold(3).jump(0).hold(4);
  pen.jump(0.1).hold(1.5).jump(0.2).hold(1.5).jump(0.1).hold(1.5).jump(0).hold(3);
  pen.jump(1).hold(3).jump(0).hold(4);
  return pen.done();
}

}  // namespace

std::vector<Waveform> experiment_menu(const RigLimits& limits) {
  return {rest_and_repeat(limits), three_rates(limits),      staircase(limits),
          minor_loops(limits),     amplitude_ladder(limits), sharp_steps(limits)};
}

std::vector<double> sampled_kpa(const Waveform& waveform, double interval_s) {
  std::vector<double> samples;
  const std::vector<Corner>& corners = waveform.corners;
  const auto count = static_cast<std::size_t>(std::floor(waveform.duration_s() / interval_s + 1e-6));
  std::size_t next = 1;
  for (std::size_t i = 0; i <= count; ++i) {
    const double time_s = static_cast<double>(i) * interval_s;
    while (next + 1 < corners.size() && corners[next].time_s < time_s) ++next;
    const Corner& from = corners[next - 1];
    const Corner& to = corners[next];
    const double share = std::clamp((time_s - from.time_s) / (to.time_s - from.time_s), 0.0, 1.0);
    samples.push_back(from.pressure_kpa + share * (to.pressure_kpa - from.pressure_kpa));
  }
  return samples;
}

}  // namespace softgrip::sysid
