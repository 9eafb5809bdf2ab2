// Measures how often the 95 % intervals of identified parameters cover the true values. The logs are
// simulated with randomly changed models and with white or correlated noise.
//
//   Usage: sysid_coverage [LOGS [RATE_HZ [FIRST_SEED]]]
//
// Each fit uses one log of the signal tp1. Each true parameter deviates from the start value by 5 % (standard
// deviation).
//
// The RMSE of a fit is smaller than the standard deviation of the added noise, because the fit follows a part
// of the noise. The expected RMSE of a correct fit is computed from H = J (J'J)^-1 J' and the correlation
// matrix R of the noise, where J is the Jacobian of the fit. The expected sum of squared residuals is s^2 (n
// - tr(H R)) for n samples and noise of standard deviation s. For white noise, tr(H R) is the number of
// parameters. Correlated noise resembles the slow responses of the model, so the fit absorbs a larger part of
// correlated noise. Therefore, the program prints two ratios: the RMSE divided by the added noise, and the
// RMSE divided by the RMSE that is expected of a correct fit.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <Eigen/QR>

#include "base/parallel.h"
#include "sysid/fitting/residuals.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/identify.h"
#include "sysid/logs/record.h"
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

/// Result of one fit. For each combination of parameters, `inside` is true if the interval covers the true
/// value. rmse_over_noise is the RMSE divided by the standard deviation of the added noise.
struct Trial {
  std::map<std::string, bool> inside;
  double rmse_over_noise = 0;
  double expected_over_noise = 0;   ///< expected RMSE of a correct fit divided by the standard deviation of
                                    ///< the added noise
  double estimated_over_noise = 0;  ///< standard deviation of the noise that the fit estimated, divided by
                                    ///< the standard deviation of the added noise
  bool failed = true;
};

/// Returns the expected RMSE of a correct fit divided by the standard deviation of the noise. This ratio is
/// sqrt(1 - tr(H R) / n) at the model `truth` (see the first comment of this file). `correlation` is the
/// lag-1 autocorrelation of the noise.
double expected_ratio(const model::Model& truth, const Identification& fit, double correlation) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (!fit.parameters[i].free) continue;
    free.push_back(model::find_path(truth, fit.parameters[i].name).value());
  }
  const auto residuals = residuals_for(fit.records, FitSpace(truth, fit.records, free));
  const auto rows = static_cast<Eigen::Index>(residuals->count());
  const auto columns = static_cast<Eigen::Index>(residuals->space().size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(rows, columns);
  const std::vector<double> z = residuals->space().z({truth, rest_starts(truth, fit.records)});
  if (!residuals->evaluate(z, {}, {jacobian.data(), static_cast<std::size_t>(jacobian.size())})) return 0;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(rows, qr.rank());
  double trace = 0;
  for (Eigen::Index c = 0; c < basis.cols(); ++c) {
    double weighted = 0;  // sum over j < i of correlation^(i - j) times basis(j, c)
    for (Eigen::Index i = 0; i < rows; ++i) {
      trace += basis(i, c) * (basis(i, c) + 2 * weighted);
      weighted = correlation * (weighted + basis(i, c));
    }
  }
  return std::sqrt(1 - trace / static_cast<double>(rows));
}

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
  trial.expected_over_noise = expected_ratio(truth, *result, correlation);
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

/// Prints the median of `values`, the 5 % and 95 % quantiles, and the share of values between 0.98 and 1.02.
void print(const char* what, std::vector<double> values) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const auto close =
      std::count_if(values.begin(), values.end(), [](double v) { return std::abs(v - 1) < 0.02; });
  std::printf("  %-52s %.4f  %.4f  %.4f  %5.1f %%\n", what, at(0.5), at(0.05), at(0.95),
              100.0 * static_cast<double>(close) / static_cast<double>(values.size()));
}

void run(const std::string& name, double correlation, std::size_t logs, double rate_hz,
         std::uint64_t first_seed) {
  std::vector<Trial> trials(logs);
  parallel_for(logs, 0,
               [&](std::size_t i) { trials[i] = fit_one(name, correlation, rate_hz, first_seed + i); });
  std::map<std::string, Count> counts;
  Count all;
  int failed = 0;
  std::vector<double> plain, expected, corrected, estimated;
  for (const Trial& trial : trials) {
    failed += trial.failed ? 1 : 0;
    if (trial.failed) continue;
    plain.push_back(trial.rmse_over_noise);
    expected.push_back(trial.expected_over_noise);
    corrected.push_back(trial.rmse_over_noise / trial.expected_over_noise);
    estimated.push_back(trial.estimated_over_noise);
    for (const auto& [combination, hit] : trial.inside) {
      counts[combination].add(hit);
      all.add(hit);
    }
  }
  std::printf("%s, %s noise (lag-1 correlation %g): %zu logs, %d failed\n", name.c_str(),
              correlation == 0 ? "white" : "correlated", correlation, logs, failed);
  std::printf("  %-52s median    5 %%      95 %%    within 2 %% of 1\n", "");
  print("fit RMSE / added noise", plain);
  print("expected RMSE / added noise: sqrt(1 - tr(H R)/n)", expected);
  print("fit RMSE / expected RMSE", corrected);
  print("estimated noise / added noise", estimated);
  std::printf("  intervals that cover the true value: %.1f %% of %d\n", all.percent(), all.trials);
  for (const auto& [combination, count] : counts) {
    std::printf("    %-32s %5.1f %% of %d\n", combination.c_str(), count.percent(), count.trials);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t logs = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 200;
  const double rate_hz = argc > 2 ? std::strtod(argv[2], nullptr) : 100;
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  std::printf(
      "noise %g mm, true parameters deviate by %g %% (standard deviation), tp1 at %g Hz, seeds from %llu\n",
      noise_mm, 100 * scatter, rate_hz, static_cast<unsigned long long>(seed));
  for (const char* name : {"zhang2025", "bench_twin"}) {
    for (const double correlation : {0.0, 0.9}) run(name, correlation, logs, rate_hz, seed);
  }
}
