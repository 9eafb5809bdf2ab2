// Measures the duration of the planning of a motion, and the duration of one simulation of the same motion.
// The third motion exceeds the limits of the rig, so the planner uses all of its iterations. To compare two
// versions, measure them alternately.

#include <benchmark/benchmark.h>

#include "bench/named_model.h"
#include "control/sequences/planner.h"
#include "model/chain.h"

namespace {

using namespace softgrip;  // NOLINT(google-build-using-namespace)

constexpr control::LimitSettings wide{0, 60, 400, 400, 0, 30, 1}, narrow{0, 30, 20, 400, 0, 30, 1};
constexpr double loop_period_s = 0.002, simulation_step_s = 0.001, duration_s = 40;
/// Approximate pressure per displacement, so that the simulated pressure is in the range of the motion.
constexpr double pressure_per_mm_kpa = 3;

control::Reference sine(double frequency_hz) {
  control::Reference reference;
  reference.start(0, 0);
  (void)reference.hold_for(control::plan_lead_s);
  (void)reference.ramp_for(6, 3);
  (void)reference.sine(13, 7, frequency_hz, duration_s * frequency_hz);
  return reference;
}

void plan(benchmark::State& state, const char* name, const control::LimitSettings& limits,
          double frequency_hz) {
  const model::Model model = bench::model_named(name);
  const control::Reference reference = sine(frequency_hz);
  int iterations = 0;
  for (auto _ : state) {
    control::Planner planner(model, limits, loop_period_s);
    iterations = planner.plan(reference, 0, reference.end_s()).iterations;
  }
  state.counters["iterations"] = iterations;
  state.counters["motion_s"] = reference.end_s();
}
BENCHMARK_CAPTURE(plan, bench_twin, "bench_twin", wide, 0.1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, zhang2025, "zhang2025", wide, 0.1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, unreachable, "zhang2025", narrow, 0.5)->Unit(benchmark::kMillisecond);

void simulate(benchmark::State& state, const char* name) {
  const model::Model model = bench::model_named(name);
  const control::Reference reference = sine(0.1);
  for (auto _ : state) {
    model::Chain<double> chain(model, {}, simulation_step_s);
    for (int k = 1; k * simulation_step_s < reference.end_s(); ++k)
      chain.step(simulation_step_s, pressure_per_mm_kpa * reference.value_at(k * simulation_step_s));
    double displacement_mm = chain.after(model::Station::load);
    benchmark::DoNotOptimize(displacement_mm);
  }
}
BENCHMARK_CAPTURE(simulate, bench_twin, "bench_twin")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simulate, zhang2025, "zhang2025")->Unit(benchmark::kMillisecond);

}  // namespace
