#include "sysid/diagnosis/verdict/valve_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Dense>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/supply_sag.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/pressure_saturation.h"
#include "sysid/diagnosis/causes/supply_sag.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/causes/valve_lag.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/logs/input_smoothing.h"

namespace softgrip::sysid {
namespace {

/// What a part must take of the mean square that the others leave: no regulator is a dead time with a lag,
/// and what makes up for that takes a part. In 16 textbook worlds none that is not there took more than 0.12,
/// and none that is less than 0.27 at twice the noise (docs/explanation/diagnosis.md).
constexpr double least_part = 0.2;
/// The same for a second time constant, which is a detail of a lag and no name of its own.
constexpr double least_detail = 0.02;
/// Of all logs together, of more every second, third, ... is taken: a valve's numbers are few.
constexpr std::size_t most_samples = 60'000;

/// A stage's number, as the named cause gives it.
struct Number {
  std::string_view name;
  std::string_view unit;
  double ValveStage::*value;
};

/// What a part is called.
struct PartName {
  ValvePart part;
  std::string_view id;
  std::size_t (*block)();
  std::vector<Number> numbers;
};

std::vector<PartName> part_names(bool two_ways) {
  const PartName one_lag{ValvePart::lag,
                         causes::ValveLag::id,
                         [] { return model::block_type<model::ValveLag>(); },
                         {{"time_constant_s", "s", &ValveStage::filling_s}}};
  const PartName two_lags{ValvePart::lag,
                          causes::ValveLag::id,
                          [] { return model::block_type<model::AsymmetricValveLag>(); },
                          {{"filling_time_constant_s", "s", &ValveStage::filling_s},
                           {"venting_time_constant_s", "s", &ValveStage::venting_s}}};
  return {{ValvePart::delay,
           causes::TransportDelay::id,
           [] { return model::block_type<model::TransportDelay>(); },
           {{"delay_s", "s", &ValveStage::delay_s}}},
          {ValvePart::dead_band,
           causes::ValveDeadband::id,
           [] { return model::block_type<model::ValveDeadband>(); },
           {{"band_kpa", "kPa", &ValveStage::band_kpa}}},
          two_ways ? two_lags : one_lag,
          {ValvePart::supply_sag,
           causes::SupplySag::id,
           [] { return model::block_type<model::SupplySag>(); },
           {{"coupling", "", &ValveStage::coupling}}},
          {ValvePart::limit,
           causes::PressureSaturation::id,
           [] { return model::block_type<model::PressureSaturation>(); },
           {{"limit_kpa", "kPa", &ValveStage::limit_kpa}}}};
}

std::vector<double> strided(const std::vector<double>& values, std::size_t stride) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); i += stride) kept.push_back(values[i]);
  return kept;
}

Log strided(const Log& log, std::size_t stride) {
  Log kept = log;
  for (std::vector<double> Log::*column : {&Log::time_s, &Log::pressure_command_kpa, &Log::displacement_mm,
                                           &Log::pressure_kpa, &Log::supply_kpa}) {
    kept.*column = strided(log.*column, stride);
  }
  return kept;
}

double range_of(const std::vector<Log>& logs, std::vector<double> Log::*column) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const Log& log : logs) {
    for (const double value : log.*column) {
      if (!std::isfinite(value)) continue;
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
  }
  return highest > lowest ? highest - lowest : 0;
}

class Valve {
 public:
  Valve(const std::vector<Log>& logs, const ValveQuestion& question) : logs_(logs), question_(question) {
    for (const Log& log : logs_)
      first_block_.push_back(blocks_of(log) + (first_block_.empty() ? 0 : first_block_.back()));
  }

  /// A fit of some parts to everything; `tolerance`: of one that is told to the last digits.
  [[nodiscard]] ValveStage fit(ValveParts parts, const std::vector<ValveStage>& from,
                               double tolerance = 1e-6) const {
    ValveFit fit = fit_of(parts, from);
    fit.tolerance = tolerance;
    return fit_valve_stage(logs_, fit);
  }

  /// The better of a fit from several places and of one from `other`, of which it has all parts and more.
  [[nodiscard]] ValveStage better_fit(ValveParts parts, const ValveStage& one,
                                      const ValveStage& other) const {
    if (!(other.rmse_kpa < 1.5 * one.rmse_kpa)) return one;
    const ValveStage again = fit(parts, {other});
    return again.rmse_kpa < one.rmse_kpa ? again : one;
  }

  /// Mean square of every block while it was not fitted, blocks taking turns [kPa^2].
  [[nodiscard]] BlockLosses held_out_losses(ValveParts parts, const ValveStage& whole) const {
    BlockLosses losses(first_block_.back(), 0);
    std::vector<double> counts(losses.size(), 0);
    for (std::size_t fold = 0; fold < 2; ++fold) {
      ValveFit fit = fit_of(parts, {whole});
      fit.is_fitted = [&](std::size_t log, std::size_t sample) { return block(log, sample) % 2 != fold; };
      const ValveStage stage = fit_valve_stage(logs_, fit);
      for (std::size_t k = 0; k < logs_.size(); ++k) {
        const std::vector<double> p = predicted_pressure_kpa(stage, logs_[k], question_.held);
        for (std::size_t i = 0; i < p.size(); ++i) {
          const double error = p[i] - logs_[k].pressure_kpa[i];
          if (block(k, i) % 2 != fold || !std::isfinite(error)) continue;
          losses[block(k, i)] += error * error;
          ++counts[block(k, i)];
        }
      }
    }
    BlockLosses means;
    for (std::size_t b = 0; b < losses.size(); ++b) {
      if (counts[b] > 0) means.push_back(losses[b] / counts[b]);
    }
    return means;
  }

  /// Standard errors of numbers that were fitted together. The larger of two: of white noise; and by the
  /// sandwich whose filling is the sum over whole blocks, so that what resembles itself within a block counts
  /// once (White, Econometrica 48, 1980; Liang & Zeger, Biometrika 73, 1986). That one is too small where few
  /// blocks say most: the edges of a few steps.
  [[nodiscard]] Eigen::VectorXd standard_errors(const ValveStage& at,
                                                const std::vector<double ValveStage::*>& numbers) const {
    const auto n = static_cast<Eigen::Index>(numbers.size());
    const auto rows = static_cast<Eigen::Index>(samples());
    Eigen::MatrixXd slopes(rows, n);
    for (Eigen::Index a = 0; a < n; ++a) slopes.col(a) = derivative(at, numbers[static_cast<std::size_t>(a)]);
    Eigen::VectorXd error = errors(at);
    for (Eigen::Index row = 0; row < rows; ++row) {
      if (std::isfinite(error[row])) continue;
      error[row] = 0;
      slopes.row(row).setZero();
    }
    Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(first_block_.back()));
    Eigen::Index row = 0;
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      for (std::size_t i = 0; i < logs_[k].size(); ++i, ++row)
        scores.col(static_cast<Eigen::Index>(block(k, i))) += error[row] * slopes.row(row).transpose();
    }
    const Eigen::MatrixXd inverse =
        (slopes.transpose() * slopes).completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::VectorXd white = inverse.diagonal() * (error.squaredNorm() / static_cast<double>(rows));
    const Eigen::VectorXd sandwich = (inverse * scores * scores.transpose() * inverse).diagonal();
    return white.cwiseMax(sandwich).cwiseSqrt();
  }

 private:
  [[nodiscard]] ValveFit fit_of(ValveParts parts, const std::vector<ValveStage>& from) const {
    ValveFit fit;
    fit.parts = parts;
    fit.gauge = true;
    fit.held = question_.held;
    fit.from = from;
    fit.tolerance = 1e-6;
    return fit;
  }

  static std::size_t blocks_of(const Log& log) {
    return std::max<std::size_t>(
        1, static_cast<std::size_t>((log.time_s.back() - log.time_s.front()) / block_length_s));
  }
  [[nodiscard]] std::size_t block(std::size_t log, std::size_t sample) const {
    const std::size_t before = log == 0 ? 0 : first_block_[log - 1];
    const double at_s = logs_[log].time_s[sample] - logs_[log].time_s.front();
    return std::min(before + static_cast<std::size_t>(at_s / block_length_s), first_block_[log] - 1);
  }

  [[nodiscard]] std::size_t samples() const {
    std::size_t all = 0;
    for (const Log& log : logs_) all += log.size();
    return all;
  }

  [[nodiscard]] Eigen::VectorXd errors(const ValveStage& stage) const {
    Eigen::VectorXd all(static_cast<Eigen::Index>(samples()));
    Eigen::Index at = 0;
    for (const Log& log : logs_) {
      const std::vector<double> p = predicted_pressure_kpa(stage, log, question_.held);
      for (std::size_t i = 0; i < p.size(); ++i) all[at++] = p[i] - log.pressure_kpa[i];
    }
    return all;
  }

  [[nodiscard]] Eigen::VectorXd derivative(const ValveStage& at, double ValveStage::*number) const {
    const double step = std::max(1e-3 * std::abs(at.*number), 1e-5);
    ValveStage above = at, below = at;
    above.*number += step;
    below.*number -= step;
    if (number == &ValveStage::filling_s && at.filling_s == at.venting_s) {  // one lag for either direction
      above.venting_s = above.filling_s;
      below.venting_s = below.filling_s;
    }
    return (errors(above) - errors(below)) / (2 * step);
  }

  const std::vector<Log>& logs_;
  const ValveQuestion& question_;
  std::vector<std::size_t> first_block_;  ///< behind every log's last one
};

double least_share_of(ValvePart part) {
  return part == ValvePart::two_ways ? least_detail : least_part;
}

ValveParts without(ValveParts parts, ValvePart part) {
  parts.reset(index_of(part));
  if (part == ValvePart::lag) parts.reset(index_of(ValvePart::two_ways));
  return parts;
}

/// A fitted stage with what it leaves.
struct Trial {
  ValveParts parts;
  ValveStage stage;
  BlockLosses losses_kpa2;
};

/// How clearly a part is there.
struct PartEvidence {
  Spread gain_kpa2;
  Spread gain_percent;
  double inclusion = 0;
  double share = 0;

  [[nodiscard]] bool is_clear(double least) const {
    return gain_kpa2.lower > 0 && inclusion >= full_inclusion && share >= least;
  }
};

class Search {
 public:
  Search(const std::vector<Log>& logs, const ValveQuestion& question)
      : logs_(logs), question_(question), valve_(logs, question) {
    bool supplied = true;
    for (const Log& log : logs) supplied = supplied && !log.supply_kpa.empty();
    ValveParts all = ValveParts().set();
    if (!supplied) all.reset(index_of(ValvePart::supply_sag));
    ValveStage narrow = valve_.fit(usual_valve_parts(), {}), wide = narrow;
    const double pressures_kpa = range_of(logs, &Log::pressure_kpa);
    narrow.band_kpa = 0.01 * pressures_kpa;
    wide.band_kpa = 0.05 * pressures_kpa;
    whole_ = {all, valve_.fit(all, {narrow, wide}), {}};
    for (std::size_t i = 0; i < valve_part_count; ++i) {
      if (!all.test(i)) continue;
      const ValveParts parts = without(all, static_cast<ValvePart>(i));
      Trial& trial = ablation_[i].emplace(Trial{parts, valve_.fit(parts, {whole_.stage}), {}});
      whole_.stage = valve_.better_fit(all, whole_.stage, trial.stage);
    }
    whole_.losses_kpa2 = valve_.held_out_losses(all, whole_.stage);
    for (std::size_t i = 0; i < valve_part_count; ++i) {
      if (!ablation_[i]) continue;
      Trial& trial = *ablation_[i];
      // What takes next to nothing where it was fitted takes nothing held out.
      const double fitted_share = 1 - std::pow(whole_.stage.rmse_kpa / trial.stage.rmse_kpa, 2);
      if (fitted_share > 0.5 * least_share_of(static_cast<ValvePart>(i))) {
        trial.losses_kpa2 = valve_.held_out_losses(trial.parts, trial.stage);
      } else {
        ablation_[i].reset();
      }
    }
  }

  [[nodiscard]] PartEvidence evidence(ValvePart part) const {
    const auto& without = ablation_[index_of(part)];
    if (!without) return {};
    const BlockLosses &before = without->losses_kpa2, &after = whole_.losses_kpa2;
    PartEvidence evidence{mean_difference(before, after, question_.seed),
                          gain_percent(before, after, question_.seed),
                          winning_share(after, before, question_.seed), 0};
    const double left = std::pow(rmse_mm(before), 2);
    evidence.share = left > 0 ? evidence.gain_kpa2.value / left : 0;
    return evidence;
  }

  [[nodiscard]] ValveFindings findings() const {
    ValveFindings found;
    const bool two_ways = evidence(ValvePart::two_ways).is_clear(least_share_of(ValvePart::two_ways));
    ValveParts kept = usual_valve_parts();
    kept.set(index_of(ValvePart::two_ways), two_ways);
    std::vector<std::pair<PartName, PartEvidence>> there;
    for (PartName& name : part_names(two_ways)) {
      const PartEvidence of = evidence(name.part);
      if (!of.is_clear(least_share_of(name.part)) || !moves_the_finger(of)) continue;
      kept.set(index_of(name.part));
      there.emplace_back(std::move(name), of);
    }
    found.stage = valve_.fit(kept, {whole_.stage}, 1e-12);
    found.heldout_rmse_kpa = rmse_mm(valve_.held_out_losses(kept, found.stage));
    if (found.stage.is_far_off()) return found;
    for (const auto& [name, of] : there) {
      NamedCause named = named_as(name, of);
      if (position_of(question_.given, named.cause)) continue;
      named.parameters = parameters_of(name, found.stage, kept);
      found.named.push_back(std::move(named));
    }
    return found;
  }

 private:
  [[nodiscard]] bool moves_the_finger(const PartEvidence& of) const {
    const double pressures_kpa = range_of(logs_, &Log::pressure_kpa);
    if (!(pressures_kpa > 0)) return false;
    const double gain_mm_per_kpa = range_of(logs_, &Log::displacement_mm) / pressures_kpa;
    return gain_mm_per_kpa * std::sqrt(of.gain_kpa2.value) > question_.noise_mm;
  }

  /// The part's numbers; what was fitted beside them makes them less certain.
  [[nodiscard]] std::vector<CauseParameter> parameters_of(const PartName& name, const ValveStage& stage,
                                                          ValveParts kept) const {
    std::vector<double ValveStage::*> numbers;
    for (const Number& number : name.numbers) numbers.push_back(number.value);
    const auto beside = [&](double ValveStage::*number, bool fitted) {
      if (fitted && std::find(numbers.begin(), numbers.end(), number) == numbers.end())
        numbers.push_back(number);
    };
    const auto has = [&](ValvePart part) { return kept.test(index_of(part)); };
    beside(&ValveStage::gauge_gain, true);
    beside(&ValveStage::gauge_zero_kpa, true);
    beside(&ValveStage::delay_s, has(ValvePart::delay));
    beside(&ValveStage::band_kpa, has(ValvePart::dead_band));
    beside(&ValveStage::filling_s, has(ValvePart::lag));
    beside(&ValveStage::venting_s, has(ValvePart::two_ways));
    beside(&ValveStage::coupling, has(ValvePart::supply_sag));
    beside(&ValveStage::limit_kpa, has(ValvePart::limit));
    const Eigen::VectorXd errors = valve_.standard_errors(stage, numbers);
    std::vector<CauseParameter> parameters;
    for (std::size_t i = 0; i < name.numbers.size(); ++i) {
      const Number& number = name.numbers[i];
      const double value = stage.*number.value, half = 1.96 * errors[static_cast<Eigen::Index>(i)];
      parameters.push_back({std::string(number.name),
                            std::string(number.unit),
                            value,
                            {value - half, value + half},
                            std::isfinite(half) && half > 0});
    }
    return parameters;
  }

  static NamedCause named_as(const PartName& name, const PartEvidence& of) {
    NamedCause named;
    named.cause = *find_cause(name.id);
    named.block_type = name.block();
    named.heldout_gain_percent = of.gain_percent;
    named.gain_kpa2 = of.gain_kpa2;
    named.inclusion = of.inclusion;
    return named;
  }

  const std::vector<Log>& logs_;
  const ValveQuestion& question_;
  Valve valve_;
  Trial whole_;
  std::array<std::optional<Trial>, valve_part_count> ablation_;
};

}  // namespace

std::optional<ValveFindings> find_in_valve(const std::vector<Log>& logs, const ValveQuestion& question) {
  std::size_t samples = 0;
  for (const Log& log : logs) {
    if (log.pressure_kpa.empty()) return std::nullopt;
    samples += log.size();
  }
  if (!(range_of(logs, &Log::pressure_kpa) > 0)) return std::nullopt;
  const std::size_t stride = 1 + samples / most_samples;
  std::vector<Log> measured;
  for (const Log& log : logs) {
    measured.push_back(strided(log, stride));
    if (!log.supply_kpa.empty()) (void)smooth_input(measured.back().time_s, measured.back().supply_kpa);
  }
  return Search(measured, question).findings();
}

}  // namespace softgrip::sysid
