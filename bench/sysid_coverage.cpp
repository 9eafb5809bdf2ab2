// How often the 95 % intervals hold the truth: scattered truths, simulated logs, white and correlated noise.
//
//   bench_sysid_coverage [LOGS [RATE_HZ [FIRST_SEED]]]
//
// One log of tp1 per fit; every parameter of the truth is off the start's by 5 % (standard deviation).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "sysid/combinations.h"
#include "sysid/identify.h"
#include "sysid/parallel.h"
#include "sysid/trajectory.h"
#include "tests/sysid/simulated.h"

namespace {

using namespace softgrip;
using namespace softgrip::sysid;

constexpr double noise_mm = 0.05;
constexpr double scatter = 0.05;

struct Count {
  int inside = 0;
  int trials = 0;
  void add(bool hit) {
    inside += hit ? 1 : 0;
    ++trials;
  }
  [[nodiscard]] double percent() const { return trials > 0 ? 100.0 * inside / trials : 0; }
};

/// One fit: which combinations' intervals hold the truth, and the fit's RMSE over the noise that was added.
struct Trial {
  std::map<std::string, bool> inside;
  double rmse_over_noise = 0;
  double estimated_over_noise = 0;  ///< the noise as the fit estimates it, its own share given back
  bool failed = true;
};

Trial fit_one(const std::string& name, double correlation, double rate_hz, std::uint64_t seed) {
  Trial trial;
  const model::Model truth = scattered(loaded(name), scatter, seed);
  const Log log = simulated(truth, model::SignalName::tp1, rate_hz, noise_mm, seed + 1'000'000, correlation);
  const Log clean = simulated(truth, model::SignalName::tp1, rate_hz, 0, 0);
  double squares = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    squares += std::pow(log.displacement_mm[i] - clean.displacement_mm[i], 2);
  }
  IdentifyOptions options;
  options.starts = 1;
  options.threads = 1;
  const auto result = identify({log}, loaded(name), options);
  if (!result) return trial;
  trial.failed = false;
  const double added = std::sqrt(squares / static_cast<double>(log.size()));
  trial.rmse_over_noise = result->rmse_mm / added;
  trial.estimated_over_noise = result->noise.deviation_mm / added;
  for (const Combination& c : combinations_of(truth)) {
    for (const Estimate& e : result->combinations) {
      if (e.name != c.name || !e.identifiable) continue;
      const double value = c.value(truth);
      trial.inside[c.name] = value >= e.ci95->lower && value <= e.ci95->upper;
    }
  }
  return trial;
}

void run(const std::string& name, double correlation, std::size_t logs, double rate_hz,
         std::uint64_t first_seed) {
  std::vector<Trial> trials(logs);
  parallel_for(logs, 0,
               [&](std::size_t i) { trials[i] = fit_one(name, correlation, rate_hz, first_seed + i); });
  std::map<std::string, Count> counts;
  Count all;
  Count close;
  Count estimated_close;
  double lowest = 1e9;
  double highest = 0;
  int failed = 0;
  for (const Trial& trial : trials) {
    failed += trial.failed ? 1 : 0;
    if (trial.failed) continue;
    lowest = std::min(lowest, trial.rmse_over_noise);
    highest = std::max(highest, trial.rmse_over_noise);
    close.add(std::abs(trial.rmse_over_noise - 1) < 0.02);
    estimated_close.add(std::abs(trial.estimated_over_noise - 1) < 0.02);
    for (const auto& [combination, hit] : trial.inside) {
      counts[combination].add(hit);
      all.add(hit);
    }
  }
  std::printf("%s, %s noise (lag-1 correlation %g): %zu logs, %d failed\n", name.c_str(),
              correlation == 0 ? "white" : "correlated", correlation, logs, failed);
  std::printf("  fit RMSE / added noise: %.4f to %.4f, within 2 %% in %.1f %%\n", lowest, highest,
              close.percent());
  std::printf("  noise as estimated / added noise: within 2 %% in %.1f %%\n", estimated_close.percent());
  std::printf("  intervals that hold the truth: %.1f %% of %d\n", all.percent(), all.trials);
  for (const auto& [combination, count] : counts) {
    std::printf("    %-32s %5.1f %% of %d\n", combination.c_str(), count.percent(), count.trials);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t logs = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 200;
  const double rate_hz = argc > 2 ? std::strtod(argv[2], nullptr) : 100;
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  std::printf("noise %g mm, truth scattered by %g %%, tp1 at %g Hz, seeds from %llu\n", noise_mm,
              100 * scatter, rate_hz, static_cast<unsigned long long>(seed));
  for (const char* name : {"zhang2025", "bench_twin"}) {
    for (const double correlation : {0.0, 0.9}) run(name, correlation, logs, rate_hz, seed);
  }
}
