#include "bench/studies/control_study.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/studies/models.h"
#include "control/feedforward/invertibility.h"
#include "control/tuning/tracking_run.h"
#include "control/tuning/tune.h"
#include "sysid/identification/identify.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip::studies {
namespace {

using control::FeedforwardKind;

/// Sampling rate of the simulated logs from which models are identified.
constexpr double log_rate_hz = 100;
constexpr double log_noise_mm = 0.05;
// Ids of those parts of the study that use random numbers. Each part derives its seeds from its id, so the
// seeds of the parts are independent.
constexpr std::uint64_t fingers_part = 1;
constexpr std::uint64_t tuning_part = 2;
constexpr std::uint64_t noise_part = 3;

control::LimitSettings limits() {
  return {0, 60, 400, 400, 0, 30, 1};
}

control::ChannelSettings channel_of(const ControlScheme& scheme) {
  control::ChannelSettings channel;
  channel.name = scheme.id;
  channel.model = scheme.believed;
  channel.feedforward = {scheme.kind, 0};
  channel.limits = limits();
  channel.plausibility.max_speed_mm_per_s = 1e6;
  return channel;
}

struct Identified {
  model::Model model;
  double rmse_mm = 0;
};

Identified identify_twin(const model::Model& start, const ControlStudyOptions& options) {
  std::vector<sysid::Log> logs;
  for (const model::SignalName signal : {model::SignalName::tp1, model::SignalName::sp1}) {
    logs.push_back(sysid::sampled_signal(signal, log_rate_hz));
    simulate(bench_twin(), {log_noise_mm, options.seed + logs.size()}, logs.back());
  }
  sysid::IdentifyOptions fit;
  fit.starts = options.starts;
  fit.seed = options.seed;
  fit.threads = options.threads;
  const auto result = sysid::identify(logs, start.blocks.empty() ? sysid::base_model(logs, 2) : start, fit);
  if (!result) return {start, std::numeric_limits<double>::quiet_NaN()};
  return {result->fitted, result->rmse_mm};
}

/// Returns the published Bouc-Wen element with beta reduced to 0.9 alpha. With the reduced beta, the element
/// has no inverse response and can be inverted.
model::Model cut_down(const model::Model& published) {
  std::vector<double> values = model::flat_values(published);
  values[model::find_path(published, "bouc_wen.beta_mm_per_kpa").value()] =
      0.9 * values[model::find_path(published, "bouc_wen.alpha_mm_per_kpa").value()];
  return model::with_values(published, values);
}

std::vector<ControlScheme> schemes_of(const ControlStudy& study) {
  const model::Model twin = bench_twin();
  const model::Model published = published_model(2);
  std::vector<ControlScheme> schemes{
      {"pid", "PID alone", FeedforwardKind::none, twin, twin, {}, {}},
      {"published",
       "inverse of the published Bouc-Wen element, with PID",
       FeedforwardKind::bouc_wen,
       twin,
       published,
       {},
       {}},
      {"published_cut",
       "inverse of the published Bouc-Wen element (beta reduced to 0.9 alpha), with PID",
       FeedforwardKind::bouc_wen,
       twin,
       cut_down(published),
       {},
       {}},
      {"full_identified",
       "inverse of the identified model (published structure), with PID",
       FeedforwardKind::full_model,
       twin,
       study.identified,
       {},
       {}},
      {"planned_identified",
       "plan from the identified model (published structure), with PID",
       FeedforwardKind::planned,
       twin,
       study.identified,
       {},
       {}},
      {"full_extended",
       "inverse of the identified model (extended structure), with PID",
       FeedforwardKind::full_model,
       twin,
       study.extended,
       {},
       {}},
      {"planned_extended",
       "plan from the identified model (extended structure), with PID",
       FeedforwardKind::planned,
       twin,
       study.extended,
       {},
       {}},
      {"pid_on_published",
       "a finger that follows the published model: PID alone",
       FeedforwardKind::none,
       published,
       published,
       {},
       {}},
      {"planned_on_published",
       "a finger that follows the published model: plan, with PID",
       FeedforwardKind::planned,
       published,
       published,
       {},
       {}}};
  for (ControlScheme& scheme : schemes) {
    const auto accepted =
        control::check_feedforward(scheme.believed, {scheme.kind, 0}, limits(), 1 / study.options.rate_hz);
    if (!accepted) scheme.refusal = accepted.error().with_advice();
  }
  return schemes;
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.5), at(0.05), at(0.95)};
}

/// Returns the largest amplitude that bench_twin can track at a frequency, but not more than the amplitude of
/// the study. The lowest pressure of 0 kPa and the creep limit the amplitude.
double reachable_amplitude_mm(double frequency_hz, const ControlStudyOptions& options) {
  constexpr double within_reach_mm = 0.005;
  control::TrackingRun run;
  run.settings.model = bench_twin();
  run.settings.limits = limits();
  run.settings.feedforward.kind = FeedforwardKind::full_model;
  run.finger = bench_twin();
  run.rate_hz = options.rate_hz;
  run.mean_mm = options.mean_mm;
  run.frequency_hz = frequency_hz;
  run.noise_mm = 0;
  run.settling_cycles = run.measured_cycles = 1;
  for (run.amplitude_mm = options.amplitude_mm; run.amplitude_mm > 1; run.amplitude_mm -= 0.5) {
    if (control::track(run).rmse_mm < within_reach_mm) break;
  }
  return run.amplitude_mm;
}

control::Tuned tune_for(const ControlScheme& scheme, double frequency_hz, double amplitude_mm,
                        const ControlStudyOptions& options) {
  control::TuneTask task;
  task.channel = channel_of(scheme);
  task.finger = scheme.finger;
  task.rate_hz = options.rate_hz;
  task.mean_mm = options.mean_mm;
  task.amplitude_mm = amplitude_mm;
  task.frequencies_hz = {frequency_hz};
  task.noise_mm = options.noise_mm;
  task.mismatch = options.mismatches.front();
  task.draws = options.search_draws;
  task.most_sensitivity = options.most_sensitivity;
  task.seed = derived_seed(options.seed, tuning_part);
  task.iterations = options.iterations;
  return control::tune(task);
}

ControlFigure figure_of(const ControlScheme& scheme, const control::Tuned& tuned, double frequency_hz,
                        double amplitude_mm, double mismatch, const ControlStudyOptions& options) {
  ControlFigure figure;
  figure.amplitude_mm = amplitude_mm;
  figure.frequency_hz = frequency_hz;
  figure.mismatch = mismatch;
  figure.pid = tuned.pid;
  figure.sensitivity = tuned.sensitivity;
  figure.limited_by = tuned.limited_by;
  control::TrackingRun run;
  run.settings = channel_of(scheme);
  run.settings.pid = tuned.pid;
  run.rate_hz = options.rate_hz;
  run.mean_mm = options.mean_mm;
  run.amplitude_mm = amplitude_mm;
  run.frequency_hz = frequency_hz;
  run.noise_mm = options.noise_mm;
  run.settling_cycles = frequency_hz < 0.1 ? 0.5 : 1;
  run.measured_cycles = 1;
  control::PressurePlan plan;
  if (scheme.kind == FeedforwardKind::planned) {
    plan = control::plan_for(run);
    run.plan = &plan;
  }
  std::vector<double> most;
  const std::uint64_t fingers = derived_seed(options.seed, fingers_part);
  const std::uint64_t noise = derived_seed(options.seed, noise_part);
  const double share = 1.0 / options.draws;
  for (int i = 0; i < options.draws; ++i) {
    const auto part = static_cast<std::uint64_t>(i);
    run.finger = control::with_scatter(scheme.finger, mismatch, derived_seed(fingers, part));
    run.seed = derived_seed(noise, part);
    const control::TrackingResult result = control::track(run);
    figure.draws_mm.push_back(result.rmse_mm);
    most.push_back(result.worst_mm);
    figure.pressure_mean_kpa += share * result.pressure_mean_kpa;
    figure.pressure_most_kpa = std::max(figure.pressure_most_kpa, result.pressure_most_kpa);
    figure.out_of_reach_share += share * result.out_of_reach_share;
  }
  figure.rmse_mm = spread_of(figure.draws_mm);
  figure.most_mm = spread_of(std::move(most));
  figure.percent_of_stroke = 100 * figure.rmse_mm.median / (2 * amplitude_mm);
  return figure;
}

}  // namespace

const ControlFigure* ControlStudy::find(const std::string& id, double frequency_hz, double mismatch) const {
  for (const ControlScheme& scheme : schemes) {
    if (scheme.id != id) continue;
    for (const ControlFigure& figure : scheme.figures) {
      if (figure.frequency_hz == frequency_hz && figure.mismatch == mismatch) return &figure;
    }
  }
  return nullptr;
}

ControlStudy study_control(const ControlStudyOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto say = [&](const std::string& text) {
    if (options.progress) options.progress(text);
  };
  ControlStudy study;
  study.options = options;
  say("identify models from responses of the simulated rig");
  const Identified base = identify_twin({}, options);
  study.identified = base.model;
  study.identified_rmse_mm = base.rmse_mm;
  const Identified extended = identify_twin(ordinary_model(0.06, 0.06), options);
  study.extended = extended.model;
  study.extended_rmse_mm = extended.rmse_mm;
  study.schemes = schemes_of(study);

  struct Job {
    ControlScheme* scheme;
    double frequency_hz;
    double amplitude_mm;
    std::vector<ControlFigure> figures;
  };
  std::vector<Job> jobs;
  for (const double frequency : options.frequencies_hz) {
    const double amplitude = reachable_amplitude_mm(frequency, options);
    for (ControlScheme& scheme : study.schemes) {
      if (scheme.refusal.empty()) jobs.push_back({&scheme, frequency, amplitude, {}});
    }
  }
  std::atomic<std::size_t> done{0};
  parallel_for(jobs.size(), options.threads, [&](std::size_t i) {
    Job& job = jobs[i];
    const control::Tuned tuned = tune_for(*job.scheme, job.frequency_hz, job.amplitude_mm, options);
    for (const double mismatch : options.mismatches) {
      job.figures.push_back(
          figure_of(*job.scheme, tuned, job.frequency_hz, job.amplitude_mm, mismatch, options));
    }
    say(std::to_string(++done) + " of " + std::to_string(jobs.size()) + ": " + job.scheme->id);
  });
  for (Job& job : jobs) {
    std::move(job.figures.begin(), job.figures.end(), std::back_inserter(job.scheme->figures));
  }
  study.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return study;
}

}  // namespace softgrip::studies
