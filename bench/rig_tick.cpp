// Measures the duration of a whole tick of a rig: two fingers with full_model and PID, sequence, supervisor
// and fault monitor. Only RigController::tick is timed; the simulated fingers advance between the timed
// calls. To compare models, measure the models alternately, with the options
// --benchmark_enable_random_interleaving=true --benchmark_repetitions=9.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "bench/named_model.h"
#include "bench/play_model.h"
#include "control/sequences/sequence_file.h"
#include "control/tick/rig_controller.h"
#include "model/chain.h"

namespace {

using namespace softgrip;  // NOLINT(google-build-using-namespace)

control::RigSettings settings(const model::Model& model, double rate_hz) {
  control::ChannelSettings channel;
  channel.model = model;
  channel.pid = {0.5, 3, 0.01, 0.02, 1, control::AntiWindup::back_calculation, 0.3};
  channel.feedforward.kind = control::FeedforwardKind::full_model;
  channel.limits = {0, 60, 300, 600, -1, 35, 2};
  control::RigSettings rig;
  rig.rate_hz = rate_hz;
  for (const char* name : {"left", "right"}) {
    channel.name = name;
    rig.channels.push_back(channel);
  }
  return rig;
}

/// Measures ticks during the sine of config/sequences/track_sine.yaml. The sine is repeated until the
/// benchmark ends.
void rig_tick(benchmark::State& state, const model::Model& model) {
  const control::RigSettings rig = settings(model, static_cast<double>(state.range(0)));
  const double period_s = 1 / rig.rate_hz;
  document::Problems problems;
  const auto sequence = bench::or_exit(
      control::load_sequence(SOFTGRIP_SOURCE_DIR "/config/sequences/track_sine.yaml", problems), problems);
  const auto track = bench::or_exit(control::prepare(sequence, rig, problems), problems);
  control::RigController controller(rig);
  std::vector<model::Chain<double>> fingers(2, model::Chain<double>(rig.channels[0].model, {}, period_s));
  std::vector<model::Reading> readings(2);
  control::TickInput input;
  const control::TickOutput& output = controller.output();
  input.readings = readings;
  input.bus.connected = true;
  std::vector<double> times_ns;
  times_ns.reserve(1 << 22);
  const auto one_period = [&] {
    input.now += std::llround(1e9 * period_s);
    for (std::size_t i = 0; i < 2; ++i) {
      readings[i].displacement_mm = fingers[i].reading_mm() + (readings[i].sequence % 2 == 0 ? 0.01 : -0.01);
      readings[i].command_readback_kpa = output.channels[i].command_kpa;
      readings[i].sampled_at = input.now;
      readings[i].validity = model::Validity::valid;
      ++readings[i].sequence;
    }
    input.request = {};
    if (output.state == control::State::idle) input.request = {control::Request::Kind::start, 1, &track};
    const auto start = std::chrono::steady_clock::now();
    controller.tick(input);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    for (std::size_t i = 0; i < 2; ++i) {
      fingers[i].step(0, output.channels[i].command_kpa);
      fingers[i].step(period_s, output.channels[i].command_kpa);
    }
    return took.count();
  };
  while (output.state != control::State::running) one_period();
  for ([[maybe_unused]] auto _ : state) {
    const double took_s = one_period();
    state.SetIterationTime(took_s);
    if (times_ns.size() < times_ns.capacity()) times_ns.push_back(1e9 * took_s);
  }
  std::sort(times_ns.begin(), times_ns.end());
  const auto at = [&](double share) {
    return times_ns[static_cast<std::size_t>(share * static_cast<double>(times_ns.size() - 1))];
  };
  state.counters["p50_ns"] = at(0.5);
  state.counters["p99_ns"] = at(0.99);
  state.counters["p99.9_ns"] = at(0.999);
}
BENCHMARK_CAPTURE(rig_tick, bench_twin, bench::model_named("bench_twin"))
    ->ArgName("rate_hz")
    ->Arg(200)
    ->Arg(1000)
    ->UseManualTime();
BENCHMARK_CAPTURE(rig_tick, twelve_plays, bench::play_model())
    ->ArgName("rate_hz")
    ->Arg(200)
    ->Arg(1000)
    ->UseManualTime();

}  // namespace
