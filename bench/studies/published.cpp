#include "bench/studies/published.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>

#include "base/random.h"
#include "bench/studies/invertible_match.h"
#include "bench/studies/models.h"
#include "control/feedforward/actuator_inverse.h"
#include "control/feedforward/invertibility.h"
#include "model/blocks/bouc_wen.h"
#include "model/chain.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/identify.h"
#include "sysid/logs/record.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip::studies {
namespace {

constexpr double most_kpa = 60;

struct Hidden {
  double lag_s, delay_s, planned_ratio;
};
constexpr std::array<Hidden, 5> hidden{
    {{0, 0, 0.57}, {0.05, 0.02, 0.78}, {0.10, 0.05, 1.28}, {0.15, 0.05, 1.69}, {0.25, 0.10, 9.5}}};
constexpr std::array<double, 4> etas_per_bar{0.5, 1, 2, 4};
/// Ratios beta/alpha of the Bouc-Wen elements whose inverse is computed. The element with the first ratio is
/// invertible. The last ratio is that of the published element.
constexpr std::array<double, 8> ratios{0.5, 0.8, 0.95, 1.0, 1.05, 1.25, 1.75, 17.207 / 7.079};
/// Frequency and duration of the pressure that each inverse must compute from the response: a sine from 0 to
/// 60 kPa and back.
constexpr double inverse_hz = 0.1;
constexpr double inverse_s = 20;

control::LimitSettings working_range() {
  return {0, most_kpa, 400, 400, 0, 100, 1};
}

std::string refusal_of(const model::Model& model, control::FeedforwardKind kind, double tick_s) {
  const auto accepted = control::check_feedforward(model, {kind, 0}, working_range(), tick_s);
  return accepted ? std::string() : accepted.error().with_advice();
}

/// Returns the number (1 or 2) of the Kelvin-Voigt branch with the smaller time constant.
int faster_branch(const model::Model& model) {
  const double tau1 =
      value_of(model, "kelvin_voigt.c1_kpa_s_per_mm") / value_of(model, "kelvin_voigt.k1_kpa_per_mm");
  const double tau2 =
      value_of(model, "kelvin_voigt.c2_kpa_s_per_mm") / value_of(model, "kelvin_voigt.k2_kpa_per_mm");
  return tau1 < tau2 ? 1 : 2;
}

tl::expected<sysid::Identification, std::string> identify_with(const model::Model& truth, Triangles choice,
                                                               const PublishedOptions& options,
                                                               sysid::Log& log) {
  log = triangles(choice, options.rate_hz);
  simulate(truth, {options.noise_mm, options.seed}, log);
  sysid::IdentifyOptions fit;
  fit.starts = options.starts;
  fit.seed = options.seed;
  fit.threads = options.threads;
  return sysid::identify({log}, sysid::base_model({log}, 2), fit);
}

HiddenLatency identify_behind(const Hidden& valve, const PublishedOptions& options, PublishedStudy& study) {
  HiddenLatency row;
  row.lag_s = valve.lag_s;
  row.delay_s = valve.delay_s;
  row.planned_ratio = valve.planned_ratio;
  const model::Model truth = ordinary_model(valve.lag_s, valve.delay_s);
  row.true_ratio = wrong_way_ratio(truth);
  sysid::Log log;
  if (const auto other = identify_with(truth, Triangles::rising, options, log)) {
    row.other_ratio = wrong_way_ratio(other->fitted);
  }
  const auto result = identify_with(truth, Triangles::mixed, options, log);
  row.span_mm = sysid::span_mm(log);
  if (!result) return row;
  row.fitted = result->fitted;
  row.rmse_mm = result->rmse_mm;
  row.ratio = wrong_way_ratio(row.fitted);
  const bool first = faster_branch(row.fitted) == 1;
  row.k2_kpa_per_mm =
      value_of(row.fitted, first ? "kelvin_voigt.k1_kpa_per_mm" : "kelvin_voigt.k2_kpa_per_mm");
  row.c2_kpa_s_per_mm =
      value_of(row.fitted, first ? "kelvin_voigt.c1_kpa_s_per_mm" : "kelvin_voigt.c2_kpa_s_per_mm");
  row.tau2_s = row.c2_kpa_s_per_mm / row.k2_kpa_per_mm;
  row.refused = !refusal_of(row.fitted, control::FeedforwardKind::full_model, 1 / options.rate_hz).empty();
  study.latency_mm = result->scores.front().prediction_mm;
  study.latency_log = std::move(log);
  return row;
}

/// Returns the model of an ordinary finger behind a valve. The fit to the published response starts from this
/// model.
model::Model match_start() {
  model::Model start = ordinary_model(0.06, 0.06);
  std::vector<double> values = model::flat_values(start);
  const auto set = [&](const char* path, double value) {
    values[model::find_path(start, path).value()] = value;
  };
  set("kelvin_voigt.k0_kpa_per_mm", value_of(published_model(1), "kelvin_voigt.k0_kpa_per_mm"));
  return model::with_values(start, values);
}

double rmse_between(const model::Model& model, const sysid::Log& log, std::vector<double>* answer = nullptr) {
  sysid::Log own = log;
  simulate(model, {}, own);
  double squares = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const double miss = own.displacement_mm[i] - log.displacement_mm[i];
    squares += miss * miss;
  }
  if (answer != nullptr) *answer = std::move(own.displacement_mm);
  return std::sqrt(squares / static_cast<double>(log.size()));
}

PublishedMatch match_published(double eta_per_bar, const PublishedOptions& options, PublishedStudy& study) {
  PublishedMatch row;
  row.eta_per_bar = eta_per_bar;
  const model::Model published = published_model(eta_per_bar);
  sysid::Log log = sysid::sampled_signal(model::SignalName::tp1, options.rate_hz);
  simulate(published, {}, log);
  row.span_mm = sysid::span_mm(log);
  row.model = invertible_match({log}, match_start(), {0.8, options.starts, options.seed, options.threads});
  const bool first = study.match_log.size() == 0;
  row.rmse_mm = rmse_between(row.model, log, first ? &study.match_mm : nullptr);
  if (first) study.match_log = std::move(log);
  sysid::Log other = sysid::sampled_signal(model::SignalName::tp2, options.rate_hz);
  simulate(published, {}, other);
  row.other_rmse_mm = rmse_between(row.model, other);
  row.lag_s = value_of(row.model, "valve_lag.time_constant_s");
  row.delay_s = value_of(row.model, "transport_delay.delay_s");
  row.ratio = wrong_way_ratio(row.model);
  return row;
}

/// Returns the published Bouc-Wen element with beta = `ratio` alpha.
model::Model element(double ratio) {
  const model::Model published = model::only(
      published_model(2), [](const model::BlockInfo& info) { return model::is<model::BoucWen>(info); });
  std::vector<double> values = model::flat_values(published);
  values[1] = ratio * values[0];
  return model::with_values(published, values);
}

/// Computes the explicit ("multiplicative") inverse of a Bouc-Wen element: the pressure p(k) = (y(k) +
/// h(k-1))/alpha for the displacement y and the hysteretic state h. Sets `growth` to the factor by which an
/// error of p grows per sample.
std::vector<double> explicit_inverse(const model::Model& element, const std::vector<double>& wanted_mm,
                                     double tick_s, double& growth) {
  const double alpha = model::flat_values(element)[0];
  model::Chain<double> chain(element, {}, tick_s);
  chain.reset(0);
  std::vector<double> pressures;
  double p = 0;
  for (const double y : wanted_mm) {
    const double h = alpha * p - chain.after(model::Station::actuator);
    p = (y + h) / alpha;
    chain.step(tick_s, p);
    pressures.push_back(p);
  }
  // Computes the factor by which a small error of the pressure grows within one sample, for a constant
  // reference.
  chain.reset(0);
  constexpr double small_kpa = 1e-6;
  chain.step(tick_s, small_kpa);
  growth = (alpha * small_kpa - chain.after(model::Station::actuator)) / alpha / small_kpa;
  return pressures;
}

void implicit_inverse(const model::Model& element, const std::vector<double>& wanted_mm, double tick_s,
                      InverseTrial& trial) {
  control::ActuatorInverse inverse(element, tick_s);
  double last = 0;
  for (const double y : wanted_mm) {
    const auto solution = inverse.solve(y, 0, most_kpa);
    inverse.advance(solution.pressure_kpa);
    if (!solution.reached) trial.unreached_share += 1 / static_cast<double>(wanted_mm.size());
    trial.implicit_jump_kpa = std::max(trial.implicit_jump_kpa, std::abs(solution.pressure_kpa - last));
    last = solution.pressure_kpa;
    trial.implicit_kpa.push_back(last);
  }
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

InverseTrial try_inverse(double ratio, const std::vector<double>& true_kpa, double tick_s) {
  InverseTrial trial;
  trial.ratio = ratio;
  const model::Model bouc_wen = element(ratio);
  model::Chain<double> chain(bouc_wen, {}, tick_s);
  chain.reset(0);
  std::vector<double> wanted_mm;
  for (std::size_t i = 0; i < true_kpa.size(); ++i) {
    chain.step(tick_s, true_kpa[i]);
    wanted_mm.push_back(chain.after(model::Station::actuator));
    const double before = i == 0 ? 0 : true_kpa[i - 1];
    trial.true_jump_kpa = std::max(trial.true_jump_kpa, std::abs(true_kpa[i] - before));
  }
  trial.explicit_kpa = explicit_inverse(bouc_wen, wanted_mm, tick_s, trial.growth);
  implicit_inverse(bouc_wen, wanted_mm, tick_s, trial);
  trial.explicit_error_kpa = largest_difference(trial.explicit_kpa, true_kpa);
  trial.implicit_error_kpa = largest_difference(trial.implicit_kpa, true_kpa);
  trial.refused = !refusal_of(bouc_wen, control::FeedforwardKind::bouc_wen, tick_s).empty();
  return trial;
}

/// Computes the response of the published element to its first loading. Stores the pressure at which the
/// response stops falling, the pressure at which it returns to 0, and its lowest value.
void first_loading(PublishedStudy& study) {
  model::Chain<double> chain(element(ratios.back()));
  chain.reset(0);
  study.back_at_kpa = std::numeric_limits<double>::quiet_NaN();
  constexpr double step_kpa = 0.01;
  for (int i = 1; i * step_kpa <= most_kpa; ++i) {
    chain.step(0, i * step_kpa);
    const double y = chain.after(model::Station::actuator);
    if (-y > study.falls_by_mm) {
      study.falls_by_mm = -y;
      study.falls_until_kpa = i * step_kpa;
    }
    if (y > 0 && std::isnan(study.back_at_kpa)) study.back_at_kpa = i * step_kpa;
  }
}

void study_inverses(PublishedStudy& study) {
  const double tick_s = 1 / study.options.rate_hz;
  const long ticks = std::lround(inverse_s * study.options.rate_hz);
  for (long i = 1; i < ticks; ++i) {
    const double t = static_cast<double>(i) * tick_s;
    study.inverse_time_s.push_back(t);
    study.inverse_true_kpa.push_back(0.5 * most_kpa * (1 - std::cos(2 * std::numbers::pi * inverse_hz * t)));
  }
  for (const double ratio : ratios) {
    study.inverses.push_back(try_inverse(ratio, study.inverse_true_kpa, tick_s));
  }
  first_loading(study);
  const model::Model published = published_model(2);
  study.published_ratio = wrong_way_ratio(published);
  study.bouc_wen_refusal = refusal_of(published, control::FeedforwardKind::bouc_wen, tick_s);
  study.full_model_refusal = refusal_of(published, control::FeedforwardKind::full_model, tick_s);
}

}  // namespace

sysid::Log triangles(Triangles choice, double rate_hz) {
  struct Triangle {
    double peak_kpa, frequency_hz;
  };
  constexpr std::array<Triangle, 6> mixed{{{20, 0.1}, {60, 0.4}, {40, 0.2}, {60, 0.1}, {30, 0.4}, {50, 0.2}}};
  constexpr std::array<Triangle, 3> rising{{{20, 0.1}, {40, 0.2}, {60, 0.4}}};
  const std::span<const Triangle> cycle =
      choice == Triangles::mixed ? std::span<const Triangle>(mixed) : std::span<const Triangle>(rising);
  const int cycles = choice == Triangles::mixed ? 2 : 4;
  sysid::Log log;
  log.name = "triangles";
  double begin_s = 0;
  std::size_t i = 0;
  const auto time_s = [&] { return static_cast<double>(i) / rate_hz; };
  const auto add = [&](double pressure_kpa) {
    log.time_s.push_back(time_s());
    log.pressure_command_kpa.push_back(pressure_kpa);
    ++i;
  };
  for (int c = 0; c < cycles; ++c) {
    for (const Triangle& triangle : cycle) {
      const double end_s = begin_s + 1 / triangle.frequency_hz;
      while (time_s() < end_s - 1e-9) {
        const double share = (time_s() - begin_s) * triangle.frequency_hz;
        add(triangle.peak_kpa * std::max(0.0, 1 - std::abs(2 * share - 1)));
      }
      begin_s = end_s;
    }
  }
  add(0);
  return log;
}

PublishedStudy study_published(const PublishedOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto say = [&](const std::string& text) {
    if (options.progress) options.progress(text);
  };
  PublishedStudy study;
  study.options = options;
  for (std::size_t i = 0; i < std::min(hidden.size(), options.most_cases); ++i) {
    say("hidden latency " + std::to_string(i + 1) + " of " + std::to_string(hidden.size()));
    study.latency.push_back(identify_behind(hidden[i], options, study));
  }
  for (std::size_t i = 0; i < std::min(etas_per_bar.size(), options.most_cases); ++i) {
    say("published response " + std::to_string(i + 1) + " of " + std::to_string(etas_per_bar.size()));
    study.matches.push_back(match_published(etas_per_bar[i], options, study));
  }
  sysid::Log response = sysid::sampled_signal(model::SignalName::tp1, options.rate_hz);
  simulate(published_model(2), {}, response);
  study.twin_rmse_mm = rmse_between(bench_twin(), response);
  say("inverses");
  study_inverses(study);
  say("the four RMSE values of the paper");
  study.paper =
      paper_table({options.seed, options.rate_hz, options.noise_mm, options.starts, options.threads});
  study.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return study;
}

}  // namespace softgrip::studies
