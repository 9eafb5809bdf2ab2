// Measures the CPU time of one channel per tick, for the whole controller and for its parts. A tick of two
// fingers with all functions may take 1 us of CPU time. The channel controller of one finger may take about
// 350 ns, so that about 300 ns remain for the functions of the whole rig.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench/named_model.h"
#include "control/feedforward/actuator_inverse.h"
#include "control/feedforward/running_model.h"
#include "control/tick/channel_controller.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/valve_deadband.h"
#include "model/named.h"

namespace {

using namespace softgrip;  // NOLINT(google-build-using-namespace)

constexpr double tick_s = 0.005;
constexpr Nanoseconds tick_ns = 5'000'000;

control::ChannelSettings settings_for(control::FeedforwardKind kind) {
  control::ChannelSettings settings;
  settings.model = bench::model_named("bench_twin");
  settings.pid = {0.5, 3, 0.01, 0.02, 1, control::AntiWindup::back_calculation, 0.3};
  settings.feedforward.kind = kind;
  settings.limits = {0, 60, 400, 400, 0, 25, 1};
  return settings;
}

/// A simulated recording of a finger that behaves exactly as its model, except for a noise of ±0.01 mm in the
/// readings. The simulation is finished before the measurement starts, so the benchmark measures only the
/// controller.
struct Tape {
  explicit Tape(const control::ChannelSettings& settings) {
    reference.start(0, 0);
    (void)reference.hold_for(0.2);
    (void)reference.ramp_for(6, 2);
    (void)reference.sine(13, 7, 0.1, 3);
    control::ChannelController controller(settings, tick_s);
    control::ChannelOutput output;
    controller.start(0, output);
    model::Chain<double> finger(settings.model, {}, tick_s);
    input.demand.mode = control::ChannelDemand::Mode::displacement;
    input.demand.reference = &reference;
    for (int k = 1; k * tick_s < reference.end_s(); ++k) {
      next(k, finger.reading_mm());
      controller.tick(input, output);
      const double command = output.command_kpa;
      finger.step(0, command);
      readings_mm.push_back(finger.reading_mm());
      finger.step(tick_s, command);
    }
  }
  void next(int k, double displacement_mm) {
    input.now = k * tick_ns;
    input.demand.time_s = k * tick_s;
    input.reading.displacement_mm = displacement_mm + (k % 2 == 0 ? 0.01 : -0.01);
    input.reading.sampled_at = input.now - tick_ns;
    input.reading.sequence = static_cast<std::uint32_t>(k);
    input.reading.validity = model::Validity::valid;
  }
  control::Reference reference;
  control::ChannelInput input;
  std::vector<double> readings_mm;
};

void tick(benchmark::State& state, const control::ChannelSettings& settings) {
  Tape tape(settings);
  control::ChannelController controller(settings, tick_s);
  control::ChannelOutput output;
  controller.start(0, output);
  int k = 1;
  while (state.KeepRunning()) {
    if (k == static_cast<int>(tape.readings_mm.size())) {
      state.PauseTiming();
      controller.start(0, output);
      k = 1;
      state.ResumeTiming();
    }
    tape.next(k, tape.readings_mm[static_cast<std::size_t>(k)]);
    controller.tick(tape.input, output);
    benchmark::DoNotOptimize(output);
    ++k;
  }
}

void channel(benchmark::State& state) {
  tick(state, settings_for(static_cast<control::FeedforwardKind>(state.range(0))));
}
BENCHMARK(channel)->ArgName("feedforward")->Arg(0)->Arg(1)->Arg(2);

// Measures a channel whose valve model consists of a dead band and a pressure regulator, and not of the usual
// first-order lag. Identification gives this valve model if the log contains the command but no measured
// pressure.
void channel_behind_a_regulator(benchmark::State& state) {
  control::ChannelSettings settings = settings_for(control::FeedforwardKind::full_model);
  model::Model& model = settings.model;
  model = model::without_block(model, *model::find_block("valve_lag"));
  model = model::with_block(model, model::block_of<model::ValveDeadband>({{"band_kpa", 0.2}}));
  model =
      model::with_block(model, model::block_of<model::PressureRegulator>({{"filling_time_constant_s", 0.015},
                                                                          {"venting_time_constant_s", 0.022},
                                                                          {"overlap_kpa", 0.4},
                                                                          {"integral_time_s", 0.3},
                                                                          {"full_open_kpa", 15}}));
  tick(state, settings);
}
BENCHMARK(channel_behind_a_regulator);

// Measures ticks of two fingers one by one, so that percentiles of the duration of a tick can be computed.
void two_channels_percentiles(benchmark::State& state) {
  const auto settings = settings_for(control::FeedforwardKind::full_model);
  Tape tape(settings);
  std::array<control::ChannelController, 2> controllers{control::ChannelController(settings, tick_s),
                                                        control::ChannelController(settings, tick_s)};
  std::array<control::ChannelOutput, 2> outputs;
  const auto start_all = [&] {
    for (std::size_t i = 0; i < 2; ++i) controllers[i].start(0, outputs[i]);
  };
  start_all();
  std::vector<double> times_ns;
  times_ns.reserve(1 << 22);
  int k = 1;
  while (state.KeepRunning()) {
    if (k == static_cast<int>(tape.readings_mm.size())) {
      start_all();
      k = 1;
    }
    tape.next(k, tape.readings_mm[static_cast<std::size_t>(k)]);
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < 2; ++i) controllers[i].tick(tape.input, outputs[i]);
    benchmark::DoNotOptimize(outputs);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    if (times_ns.size() < times_ns.capacity()) times_ns.push_back(took.count());
    ++k;
  }
  std::sort(times_ns.begin(), times_ns.end());
  const auto at = [&](double share) {
    return times_ns[static_cast<std::size_t>(share * static_cast<double>(times_ns.size() - 1))];
  };
  state.counters["p50_ns"] = at(0.5);
  state.counters["p99_ns"] = at(0.99);
  state.counters["p99.9_ns"] = at(0.999);
}
BENCHMARK(two_channels_percentiles);

void running_model(benchmark::State& state) {
  control::RunningModel model(bench::model_named("bench_twin"), tick_s, 0, 0.05);
  double t = 0;
  while (state.KeepRunning()) {
    t += 0.01;
    model.advance(20 + t);
    if (t > 20) t = 0;
    benchmark::DoNotOptimize(model.reading_mm(0.005));
  }
}
BENCHMARK(running_model);

void actuator_inverse(benchmark::State& state) {
  control::ActuatorInverse inverse(control::body_of(bench::model_named("bench_twin")), tick_s);
  control::Reference reference;
  reference.start(0, 0);
  (void)reference.ramp_for(6, 2);
  (void)reference.sine(13, 7, 0.1, 1000);
  double t = 0;
  while (state.KeepRunning()) {
    t += tick_s;
    const auto solution = inverse.solve(reference.value_at(t), 0, 60);
    inverse.advance(solution.pressure_kpa);
  }
}
BENCHMARK(actuator_inverse);

void reference_at(benchmark::State& state) {
  control::Reference reference;
  reference.start(0, 0);
  (void)reference.ramp_for(6, 2);
  (void)reference.sine(13, 7, 0.1, 1000);
  double t = 0;
  while (state.KeepRunning()) benchmark::DoNotOptimize(reference.at(t += tick_s));
}
BENCHMARK(reference_at);

}  // namespace
