#include "tools/investigation/closed_loop_gain.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <utility>

#include "base/numbers.h"
#include "base/random.h"
#include "base/text.h"
#include "control/tuning/gain_search.h"
#include "model/blocks/outliers.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/sensor_noise.h"
#include "model/catalogue.h"
#include "model/named.h"

namespace softgrip::tools {
namespace {

using control::FeedforwardKind;

constexpr double rate_hz = 100;
/// Number of simulated rigs with which the gains are searched, and number of additional rigs with which the
/// found gains are evaluated.
constexpr std::uint64_t searched_rigs = 2;
constexpr std::uint64_t judged_rigs = 5;
constexpr double largest_sensitivity = 2;
constexpr double mean_mm = 13;
constexpr double amplitude_mm = 7;
/// Smallest span of a finger for which the reference keeps its full size [mm]. The published reference
/// reaches 20 mm. A finger with a span of 22 mm reaches 20 mm with a reserve for creep.
constexpr double span_needed_mm = 22;
constexpr control::GainSearch gain_search{.iterations = 25, .coarseness = 2};

/// Returns the model without the random errors of its sensor, because the simulation adds the noise of the
/// sensor separately.
model::Model body_of(const model::Model& model) {
  return model::only(model, [](const model::BlockInfo& info) {
    return !model::is<model::SensorNoise, model::Quantisation, model::Outliers>(info);
  });
}

class Rigs {
 public:
  explicit Rigs(const ClosedLoopQuestion& question) : question_(question) {
    const double scale = std::min(1.0, question.span_mm > 0 ? question.span_mm / span_needed_mm : 1.0);
    mean_mm_ = scale * mean_mm;
    amplitude_mm_ = scale * amplitude_mm;
    const model::Model truth = body_of(question.extended);
    for (std::uint64_t i = 0; i < searched_rigs + judged_rigs; ++i) {
      rigs_.push_back(control::with_scatter(truth, question.rig_scatter, derived_seed(question.seed, i)));
    }
  }

  [[nodiscard]] double mean() const { return mean_mm_; }
  [[nodiscard]] double amplitude() const { return amplitude_mm_; }

  /// Returns the closed-loop result with a feedforward from this model. If the complete model has an inverse,
  /// the feedforward is this inverse. Otherwise, two feedforwards are compared: a plan that is computed with
  /// the model, and the inverse of the model's invertible part. The feedforward with the smaller tracking
  /// error is used. If neither feedforward can be computed, the tracking error is infinite.
  [[nodiscard]] ClosedLoopScheme with_model(const model::Model& believed) const {
    ClosedLoopScheme whole = measured(believed, FeedforwardKind::full_model);
    if (whole.refused.empty()) return whole;
    ClosedLoopScheme best = measured(believed, FeedforwardKind::planned);
    if (auto part = control::invertible_part(body_of(believed), limits(), 1 / rate_hz)) {
      ClosedLoopScheme by_part = measured(part->model, FeedforwardKind::full_model);
      if (by_part.rmse_mm < best.rmse_mm) {
        best = std::move(by_part);
        best.part = std::move(part);
      }
    }
    best.refused = std::move(whole.refused);
    return best;
  }

  [[nodiscard]] ClosedLoopScheme measured(const model::Model& believed, FeedforwardKind kind) const {
    ClosedLoopScheme scheme;
    control::TrackingRun run = run_of(body_of(believed), kind);
    if (const auto accepted = control::check_feedforward(run.settings.model, run.settings.feedforward,
                                                         run.settings.limits, 1 / rate_hz);
        !accepted) {
      scheme.refused = accepted.error().text;
      scheme.rmse_mm = std::numeric_limits<double>::infinity();
      return scheme;
    }
    scheme.feedforward = kind;
    control::PressurePlan plan;
    if (kind == FeedforwardKind::planned) {
      plan = control::plan_for(run);
      run.plan = &plan;
    }
    scheme.pid =
        control::search_gains([&](const control::PidSettings& pid) { return cost(run, pid); }, gain_search);
    run.settings.pid = scheme.pid;
    std::vector<std::pair<double, std::uint64_t>> rmse;
    for (std::uint64_t i = searched_rigs; i < rigs_.size(); ++i) rmse.emplace_back(rmse_on(run, i), i);
    std::sort(rmse.begin(), rmse.end());
    const auto& [median_mm, rig] = rmse[rmse.size() / 2];
    scheme.rmse_mm = median_mm;
    run.trace = &scheme.trace;
    static_cast<void>(rmse_on(run, rig));
    return scheme;
  }

 private:
  [[nodiscard]] control::LimitSettings limits() const {
    return {0, question_.pressure_max_kpa, 400, 400, -1e3, 1e3, 1};
  }

  [[nodiscard]] control::TrackingRun run_of(const model::Model& believed, FeedforwardKind kind) const {
    control::TrackingRun run;
    run.rate_hz = rate_hz;
    run.mean_mm = mean_mm_;
    run.amplitude_mm = amplitude_mm_;
    run.frequency_hz = question_.frequency_hz;
    run.measured_cycles = 1;
    run.noise_mm = question_.noise_mm;
    run.settings.model = believed;
    run.settings.feedforward = {kind, 0};
    run.settings.limits = limits();
    run.settings.plausibility.max_speed_mm_per_s = 1e6;
    return run;
  }

  [[nodiscard]] double rmse_on(control::TrackingRun run, std::uint64_t rig) const {
    run.finger = rigs_[rig];
    run.seed = derived_seed(question_.seed, 1000 + rig);
    const double rmse = control::track(run).rmse_mm;
    return std::isfinite(rmse) ? std::min(100.0, rmse) : 100.0;
  }

  [[nodiscard]] double cost(control::TrackingRun run, const control::PidSettings& pid) const {
    const double sensitivity =
        control::loop_margins(rigs_[0], pid, {0, question_.pressure_max_kpa}, 1 / rate_hz, 1 / rate_hz)
            .sensitivity;
    if (!(sensitivity <= largest_sensitivity)) return 1000 + std::min(100.0, sensitivity);
    run.settings.pid = pid;
    double squares = 0;
    for (std::uint64_t i = 0; i < searched_rigs; ++i) squares += std::pow(rmse_on(run, i), 2);
    return std::sqrt(squares / static_cast<double>(searched_rigs));
  }

  const ClosedLoopQuestion& question_;
  std::vector<model::Model> rigs_;
  double mean_mm_ = mean_mm;
  double amplitude_mm_ = amplitude_mm;
};

bool is_of_the_whole_model(const ClosedLoopScheme& scheme) {
  return scheme.feedforward == FeedforwardKind::full_model && !scheme.part;
}

result::Fields fields_of_scheme(const ClosedLoopScheme& scheme) {
  result::Fields fields{{"kp_kpa_per_mm", scheme.pid.kp_kpa_per_mm},
                        {"ki_kpa_per_mm_s", scheme.pid.ki_kpa_per_mm_s},
                        {"kd_kpa_s_per_mm", scheme.pid.kd_kpa_s_per_mm},
                        {"feedforward", control::name_of(scheme.feedforward)}};
  if (scheme.part) fields.emplace_back("feedforward_without", scheme.part->left_out);
  return fields;
}

}  // namespace

std::string ClosedLoopGain::reference() const {
  return significant(mean_mm, 3) + " ± " + significant(amplitude_mm, 3) + " " +
         std::string(model::name_of(output_unit)) + " at " + significant(frequency_hz, 3) + " Hz";
}

std::vector<std::string> ClosedLoopGain::notes() const {
  std::vector<std::string> notes;
  const auto refused = [&](const char* which, const ClosedLoopScheme& scheme) {
    if (is_of_the_whole_model(scheme)) return;
    const bool planned = scheme.feedforward == FeedforwardKind::planned;
    const std::string left_out = scheme.part ? with_commas(scheme.part->left_out) : "";
    notes.push_back(
        std::string("the ") + which +
        (planned ? " model has no causal inverse, so its feedforward is planned before the run. Reason: "
         : left_out.empty()
             ? " model has no feedforward, so its tracking error is the error of the PID "
               "controller alone. Reason: "
             : " model as a whole has no inverse, so its feedforward omits " + left_out + ": ") +
        scheme.refused);
  };
  refused("recalibrated", recalibrated);
  refused("extended", extended);
  notes.push_back("median of " + std::to_string(rigs) +
                  " simulated rigs; each rig is the extended model with every parameter changed by up to " +
                  significant(100 * rig_scatter, 2) + " %");
  return notes;
}

ClosedLoopGain measure_closed_loop(const ClosedLoopQuestion& question) {
  const auto began = std::chrono::steady_clock::now();
  const Rigs rigs(question);
  ClosedLoopGain gain;
  gain.mean_mm = rigs.mean();
  gain.amplitude_mm = rigs.amplitude();
  gain.output_unit = question.extended.output_unit;
  gain.frequency_hz = question.frequency_hz;
  gain.rig_scatter = question.rig_scatter;
  gain.rigs = judged_rigs;
  auto recalibrated = std::async(std::launch::async, [&] { return rigs.with_model(question.recalibrated); });
  gain.extended = rigs.with_model(question.extended);
  gain.pid_alone = rigs.measured(question.extended, FeedforwardKind::none);
  gain.recalibrated = recalibrated.get();
  for (ClosedLoopScheme* scheme : {&gain.recalibrated, &gain.extended}) {
    if (is_of_the_whole_model(*scheme) || scheme->rmse_mm < gain.pid_alone.rmse_mm) continue;
    std::string refused = std::move(scheme->refused);
    *scheme = gain.pid_alone;
    scheme->refused = std::move(refused);
  }
  gain.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return gain;
}

result::Fields fields_of(const ClosedLoopGain& gain) {
  return {{"recalibrated_rmse_mm", gain.recalibrated.rmse_mm},
          {"extended_rmse_mm", gain.extended.rmse_mm},
          {"pid_alone_rmse_mm", gain.pid_alone.rmse_mm},
          {"reference", gain.reference()},
          {"gains", result::Fields{{"recalibrated", fields_of_scheme(gain.recalibrated)},
                                   {"extended", fields_of_scheme(gain.extended)},
                                   {"pid_alone", fields_of_scheme(gain.pid_alone)}}},
          {"notes", gain.notes()},
          {"wall_s", gain.wall_s}};
}

}  // namespace softgrip::tools
