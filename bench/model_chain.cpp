// Measures the CPU time of one sample of a model for two functions. step() changes the state of the model.
// peek() computes a trial step that does not change the state; the inverse of a model needs such trial steps.
// peek() is measured with and without the derivative.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bench/named_model.h"
#include "bench/play_model.h"
#include "model/chain.h"
#include "model/dual.h"
#include "model/signals.h"

namespace softgrip::model {
namespace {

constexpr double dt = 1e-3;

std::vector<double> command() {
  const auto count = static_cast<std::size_t>(duration_s(SignalName::tp1) / dt);
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = value_kpa(SignalName::tp1, static_cast<double>(i + 1) * dt);
  return values;
}

void step_chain(benchmark::State& state, const Model& model) {
  const std::vector<double> u = command();
  Chain<double> chain(model, {}, dt);
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(chain.step(dt, u[i]));
    if (++i == u.size()) i = 0;
  }
}

void step_irregular(benchmark::State& state, const Model& model) {
  const std::vector<double> u = command();
  Chain<double> chain(model);
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(chain.step(dt * (1.0 + 1e-6 * static_cast<double>(i % 97)), u[i]));
    if (++i == u.size()) i = 0;
  }
}

template <class U>
void peek_chain(benchmark::State& state, const Model& model) {
  const std::vector<double> u = command();
  Chain<double> chain(model, {}, dt);
  for (std::size_t i = 0; i < 4321; ++i) chain.step(dt, u[i]);
  double p = chain.pressure_kpa();
  for ([[maybe_unused]] auto _ : state) {
    p += 1e-6;
    U trial(p);
    if constexpr (!std::is_same_v<U, double>) trial.v = 1.0;
    benchmark::DoNotOptimize(chain.peek(dt, trial));
  }
}

void peek_value(benchmark::State& state, const Model& model) {
  peek_chain<double>(state, model);
}
void peek_derivative(benchmark::State& state, const Model& model) {
  peek_chain<Dual<double>>(state, model);
}

BENCHMARK_CAPTURE(step_chain, zhang2025, bench::model_named("zhang2025"));
BENCHMARK_CAPTURE(step_chain, bench_twin, bench::model_named("bench_twin"));
BENCHMARK_CAPTURE(step_chain, twelve_plays, bench::play_model());
BENCHMARK_CAPTURE(step_irregular, zhang2025, bench::model_named("zhang2025"));
BENCHMARK_CAPTURE(step_irregular, bench_twin, bench::model_named("bench_twin"));
BENCHMARK_CAPTURE(step_irregular, twelve_plays, bench::play_model());
BENCHMARK_CAPTURE(peek_value, zhang2025, bench::model_named("zhang2025"));
BENCHMARK_CAPTURE(peek_value, twelve_plays, bench::play_model());
BENCHMARK_CAPTURE(peek_derivative, zhang2025, bench::model_named("zhang2025"));
BENCHMARK_CAPTURE(peek_derivative, twelve_plays, bench::play_model());

}  // namespace
}  // namespace softgrip::model
