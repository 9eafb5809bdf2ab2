// Measures the tracking accuracy on the simulated finger bench_twin and prints a table. The references are
// sines of 13 ± 7 mm at 0.05, 0.1 and 0.2 Hz, the control rate is 200 Hz, and the sensor noise is 0.03 mm.
// The parameters of the controller's model vary at random by up to ±5 % around the values of each scheme. One
// search method finds the gains of all schemes.
//
//   Usage: tracking_study [--draws N] [--search-draws N] [--seed S] [--latency-ms L] [--quantised]
//   [--max-sensitivity M]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "base/random.h"
#include "bench/named_model.h"
#include "control/feedforward/invertibility.h"
#include "control/tuning/gain_search.h"
#include "control/tuning/tracking_run.h"

namespace {

using namespace softgrip;  // NOLINT(google-build-using-namespace)
using control::FeedforwardKind;
using control::PidSettings;

struct Options {
  int draws = 40;        ///< number of random models for the results in the table
  int search_draws = 6;  ///< number of additional random models for the search of the controller gains
  std::uint64_t seed = 1;
  double latency_ms = 0;
  bool quantised = false;  ///< true: readings have 16 bits over 100 mm, and commands have 12 bits over 100
                           ///< kPa
  double max_sensitivity = 2;
};

struct Scheme {
  std::string name;
  FeedforwardKind kind = FeedforwardKind::none;
  model::Model believed;  ///< model of the controller before its parameters are varied
  double pressure_max_kpa = 60;
};

constexpr std::array<double, 3> frequencies_hz{0.05, 0.1, 0.2};
constexpr double scatter = 0.05;
constexpr double tick_s = 0.005;

/// Returns the published Bouc-Wen model with beta reduced to 0.9 of alpha. With the published beta, the model
/// has an inverse response; with the reduced beta, the model can be inverted.
model::Model regularised(const model::Model& published) {
  auto values = model::flat_values(published);
  values[model::find_path(published, "bouc_wen.beta_mm_per_kpa").value()] =
      0.9 * values[model::find_path(published, "bouc_wen.alpha_mm_per_kpa").value()];
  return model::with_values(published, values);
}

control::TrackingRun run_of(const Scheme& scheme, const Options& options, const model::Model& finger,
                            double frequency_hz, const PidSettings& pid) {
  control::TrackingRun run;
  run.finger = finger;
  run.frequency_hz = frequency_hz;
  run.exchange_s = 1e-3 * options.latency_ms;
  run.reading_step_mm = options.quantised ? 100.0 / 65536 : 0;
  run.command_step_kpa = options.quantised ? 100.0 / 4096 : 0;
  run.settings.model = scheme.believed;
  run.settings.pid = pid;
  run.settings.feedforward = {scheme.kind, run.exchange_s};
  run.settings.limits = {0, scheme.pressure_max_kpa, 400, 400, 0, 30, 1};
  run.settings.plausibility.max_speed_mm_per_s = 1e6;
  return run;
}

/// Returns random models. Their parameters deviate from the parameters of the scheme's model by up to
/// `scatter`. Models for which the feedforward of the scheme is impossible are not returned, but counted in
/// `refused`.
std::vector<model::Model> draws_of(const Scheme& scheme, int count, std::uint64_t seed, int& refused) {
  std::vector<model::Model> models;
  refused = 0;
  for (std::uint64_t i = 0; static_cast<int>(models.size()) < count && i < 100000; ++i) {
    model::Model drawn = control::with_scatter(scheme.believed, scatter, derived_seed(seed, i));
    const control::LimitSettings limits{0, scheme.pressure_max_kpa, 400, 400, 0, 30, 1};
    if (control::check_feedforward(drawn, {scheme.kind, 0}, limits, tick_s)) {
      models.push_back(std::move(drawn));
    } else {
      ++refused;
    }
  }
  return models;
}

/// Cost of a set of gains: root mean square of the RMSE over several random models, with one short simulation
/// per model. The cost is large if the stability margin of the control loop is too small.
class Cost {
 public:
  Cost(const Scheme& scheme, const Options& options, const model::Model& finger, double frequency_hz)
      : scheme_(scheme), options_(options), finger_(finger), frequency_hz_(frequency_hz) {
    int refused = 0;
    models_ = draws_of(scheme, options.search_draws, derived_seed(options.seed, 1000), refused);
  }
  double operator()(const PidSettings& pid) const {
    const double sensitivity = control::loop_margins(finger_, pid, {0, 60}, tick_s, tick_s).sensitivity;
    if (sensitivity > options_.max_sensitivity) return 10 + std::min(100.0, sensitivity);
    double squares = 0;
    for (std::size_t i = 0; i < models_.size(); ++i) {
      control::TrackingRun run = run_of(scheme_, options_, finger_, frequency_hz_, pid);
      run.settings.model = models_[i];
      run.measured_cycles = 1;
      run.seed = derived_seed(options_.seed, 2000 + i);
      const double rmse = std::min(10.0, control::track(run).rmse_mm);
      squares += rmse * rmse;
    }
    return std::sqrt(squares / static_cast<double>(models_.size()));
  }

 private:
  const Scheme& scheme_;
  const Options& options_;
  const model::Model& finger_;
  double frequency_hz_;
  std::vector<model::Model> models_;
};

PidSettings search(const Scheme& scheme, const Options& options, const model::Model& finger,
                   double frequency_hz) {
  Cost cost(scheme, options, finger, frequency_hz);
  return control::search_gains([&](const PidSettings& pid) { return cost(pid); });
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

void study(const Scheme& scheme, const Options& options, const model::Model& finger) {
  const control::LimitSettings limits{0, scheme.pressure_max_kpa, 400, 400, 0, 30, 1};
  const auto accepted = control::check_feedforward(scheme.believed, {scheme.kind, 0}, limits, tick_s);
  std::printf("\n%s\n", scheme.name.c_str());
  if (!accepted) {
    std::printf("  refused: %s\n", accepted.error().with_advice().c_str());
    return;
  }
  int refused = 0;
  const auto models = draws_of(scheme, options.draws, derived_seed(options.seed, 1), refused);
  if (refused > 0) {
    std::printf("  %d of %zu scattered models refused (no inverse over 0 to %.0f kPa) and drawn again\n",
                refused, models.size() + static_cast<std::size_t>(refused), scheme.pressure_max_kpa);
  }
  for (const double frequency : frequencies_hz) {
    const PidSettings pid = search(scheme, options, finger, frequency);
    std::vector<double> rmse, worst, residual;
    double cut = 0, reach = 0;
    for (std::size_t i = 0; i < models.size(); ++i) {
      control::TrackingRun run = run_of(scheme, options, finger, frequency, pid);
      run.settings.model = models[i];
      run.seed = derived_seed(options.seed, 5000 + i);
      const control::TrackingResult result = control::track(run);
      rmse.push_back(result.rmse_mm);
      worst.push_back(result.worst_mm);
      residual.push_back(result.residual_rms_mm);
      cut += result.cut_share / static_cast<double>(models.size());
      reach += result.out_of_reach_share / static_cast<double>(models.size());
    }
    control::TrackingRun exact = run_of(scheme, options, finger, frequency, pid);
    exact.seed = derived_seed(options.seed, 9999);
    const double sensitivity = control::loop_margins(finger, pid, {0, 60}, tick_s, tick_s).sensitivity;
    std::printf(
        "  %.2f Hz: RMSE: median %.4f mm (5 %% to 95 %% quantile: %.4f to %.4f mm); "
        "largest error: median %.3f mm; RMSE with the unvaried model: %.4f mm; kp %.4g, ki %.4g, kd %.3g, "
        "sensitivity Ms %.2f; RMS of the model residual: median %.3f mm; "
        "command limited in %.1f %%, reference out of reach in %.1f %% of the ticks\n",
        frequency, quantile(rmse, 0.5), quantile(rmse, 0.05), quantile(rmse, 0.95), quantile(worst, 0.5),
        control::track(exact).rmse_mm, pid.kp_kpa_per_mm, pid.ki_kpa_per_mm_s, pid.kd_kpa_s_per_mm,
        sensitivity, quantile(residual, 0.5), 100 * cut, 100 * reach);
    std::fflush(stdout);
  }
}

Options options_from(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const double value = i + 1 < argc ? std::atof(argv[i + 1]) : 0;
    if (name == "--quantised") {
      options.quantised = true;
      continue;
    }
    if (name == "--draws")
      options.draws = static_cast<int>(value);
    else if (name == "--search-draws")
      options.search_draws = static_cast<int>(value);
    else if (name == "--seed")
      options.seed = static_cast<std::uint64_t>(value);
    else if (name == "--latency-ms")
      options.latency_ms = value;
    else if (name == "--max-sensitivity")
      options.max_sensitivity = value;
    else {
      std::fprintf(stderr, "unknown option %s\n", argv[i]);
      std::exit(2);
    }
    ++i;
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = options_from(argc, argv);
  const model::Model twin = bench::model_named("bench_twin");
  const model::Model published = bench::model_named("zhang2025");
  std::printf(
      "bench_twin, 13 ± 7 mm, 200 Hz, noise 0.03 mm%s, exchange %.1f ms; results of %d models whose "
      "parameters vary by up to ±5 %%, seed %llu; gains by one search on %d other models, Ms <= %.2f\n",
      options.quantised ? ", quantised" : "", options.latency_ms, options.draws,
      static_cast<unsigned long long>(options.seed), options.search_draws, options.max_sensitivity);
  study({"PID alone", FeedforwardKind::none, twin, 60}, options, twin);
  study({"bouc_wen of zhang2025 + PID", FeedforwardKind::bouc_wen, published, 60}, options, twin);
  study({"bouc_wen of zhang2025 (beta reduced to 0.9 alpha) + PID", FeedforwardKind::bouc_wen,
         regularised(published), 60},
        options, twin);
  study({"bouc_wen of bench_twin + PID", FeedforwardKind::bouc_wen, twin, 60}, options, twin);
  study({"bouc_wen of bench_twin + PID, pressure limit 200 kPa (never reached)", FeedforwardKind::bouc_wen,
         twin, 200},
        options, twin);
  study({"full_model + PID", FeedforwardKind::full_model, twin, 60}, options, twin);
  return 0;
}
