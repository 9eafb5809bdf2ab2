#include "sysid/diagnosis/verdict/valve_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "base/parallel.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/leak.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/supply_sag.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/leak.h"
#include "sysid/diagnosis/causes/pressure_saturation.h"
#include "sysid/diagnosis/causes/pressure_scale.h"
#include "sysid/diagnosis/causes/supply_sag.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/causes/valve_lag.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/verdict/measured_valve.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/input_smoothing.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

/// Largest number of samples of all logs together. Logs with more samples are thinned to every second, third,
/// ... sample. A valve model has few parameters, so the remaining samples are sufficient.
constexpr std::size_t most_samples = 30'000;

/// A parameter as the report lists it: name, unit, and the member of ValveStage with its value.
struct Number {
  std::string_view name;
  std::string_view unit;
  double ValveStage::*value;
};

/// Cause as which a part of the valve model is reported, with the parameters of this cause.
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

PartName leak_name() {
  return {ValvePart::leak,
          causes::Leak::id,
          [] { return model::block_type<model::Leak>(); },
          {{"share", "", &ValveStage::leak_share}}};
}

double range_of(const std::vector<Log>& logs, std::vector<double> Log::*column) {
  std::vector<double> all;
  for (const Log& log : logs) all.insert(all.end(), (log.*column).begin(), (log.*column).end());
  return width_of(all);
}

/// Returns the smallest share of the remaining mean square that a part must explain. A separate time constant
/// for venting only refines the lag and is not reported as a cause.
double least_share_of(ValvePart part) {
  return part == ValvePart::two_ways ? limits::least_refinement_share : limits::least_explained_share;
}

ValveParts without(ValveParts parts, ValvePart part) {
  parts.reset(index_of(part));
  if (part == ValvePart::lag) parts.reset(index_of(ValvePart::two_ways));
  return parts;
}

/// A fit of the valve model with some of the possible parts, and its held-out losses.
struct Trial {
  ValveParts parts;
  ValveStage stage;
  BlockLosses losses_kpa2;
};

/// Evidence for a part of the valve model. It compares a fit with the part and a fit without the part.
struct PartEvidence {
  Spread gain_kpa2;
  Spread gain_percent;
  double inclusion = 0;
  double share = 0;

  [[nodiscard]] bool is_clear(double least) const {
    return gain_kpa2.lower > 0 && inclusion >= limits::probability && share >= least;
  }
};

class Search {
 public:
  Search(const std::vector<Log>& logs, const ValveQuestion& question)
      : logs_(logs), question_(question), valve_(logs, question.held) {
    bool supplied = true;
    for (const Log& log : logs) supplied = supplied && !log.supply_kpa.empty();
    ValveParts all =
        ValveParts().set().reset(index_of(ValvePart::leak)).reset(index_of(ValvePart::second_lag));
    if (!supplied) all.reset(index_of(ValvePart::supply_sag));
    ValveStage narrow = valve_.fit(usual_valve_parts(), {}), wide = narrow;
    const double pressures_kpa = range_of(logs, &Log::pressure_kpa);
    narrow.band_kpa = 0.01 * pressures_kpa;
    wide.band_kpa = 0.05 * pressures_kpa;
    whole_ = {all, valve_.fit(all, {narrow, wide}), {}};
    parallel_for(valve_part_count, question.threads, [&](std::size_t i) {
      if (!all.test(i)) return;
      const ValveParts parts = without(all, static_cast<ValvePart>(i));
      ablation_[i].emplace(Trial{parts, valve_.fit(parts, {whole_.stage}), {}});
    });
    for (const auto& trial : ablation_) {
      if (trial) whole_.stage = valve_.better_fit(all, whole_.stage, trial->stage);
    }
    whole_.losses_kpa2 = valve_.held_out_losses(all, whole_.stage);
    parallel_for(valve_part_count, question.threads, [&](std::size_t i) {
      if (!ablation_[i]) return;
      Trial& trial = *ablation_[i];
      // If a part reduces the error of the fit by a negligible share, it is not tested on held-out blocks.
      const double fitted_share = 1 - std::pow(whole_.stage.rmse_kpa / trial.stage.rmse_kpa, 2);
      if (fitted_share > 0.5 * least_share_of(static_cast<ValvePart>(i))) {
        trial.losses_kpa2 = valve_.held_out_losses(trial.parts, trial.stage);
      } else {
        ablation_[i].reset();
      }
    });
  }

  [[nodiscard]] PartEvidence evidence(ValvePart part) const {
    const auto& without = ablation_[index_of(part)];
    if (!without) return {};
    return evidence(without->losses_kpa2, whole_.losses_kpa2);
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
    found.noise_kpa = pressure_noise_kpa(logs_);
    found.stage = valve_.exact_fit(kept, {whole_.stage});
    found.heldout_rmse_kpa = rmse_mm(valve_.held_out_losses(kept, found.stage));
    if (found.stage.is_far_off()) return found;
    for (const auto& [name, of] : there) {
      NamedCause named = named_as(name, of);
      if (position_of(question_.given, named.cause)) continue;
      named.parameters = parameters_of(name, found.stage, kept);
      if (name.part == ValvePart::delay && may_be_second_lag())
        named.alternatives.push_back(*find_cause(causes::ValveLag::id));
      found.named.push_back(std::move(named));
    }
    add_lost_pressure(found, kept);
    return found;
  }

 private:
  [[nodiscard]] PartEvidence evidence(const BlockLosses& before, const BlockLosses& after) const {
    PartEvidence evidence{mean_difference(before, after, question_.seed),
                          gain_percent(before, after, question_.seed),
                          winning_share(after, before, question_.seed), 0};
    const double left = std::pow(rmse_mm(before), 2);
    evidence.share = left > 0 ? evidence.gain_kpa2.value / left : 0;
    return evidence;
  }

  /// Returns true if a second lag in series fits the pressure almost as well as the dead time.
  [[nodiscard]] bool may_be_second_lag() const {
    const ValveParts parts = without(whole_.parts, ValvePart::delay).set(index_of(ValvePart::second_lag));
    ValveStage start = whole_.stage;
    start.second_s = start.delay_s;
    start.delay_s = 0;
    const ValveStage lagging = valve_.fit(parts, {start});
    return !evidence(valve_.held_out_losses(parts, lagging), whole_.losses_kpa2)
                .is_clear(limits::least_explained_share);
  }

  void add_lost_pressure(ValveFindings& found, ValveParts kept) const {
    // A falling supply pressure or a pressure limit reduces the pressure too. The search for a leak therefore
    // comes after the fit of these two parts.
    if (!(whole_.stage.gauge_gain < 1 - scales_agree_within)) return;
    const auto lost = find_lost_pressure(logs_, valve_, kept, found.stage);
    if (!lost) return;
    const PartName name = leak_name();
    const PartEvidence of = evidence(lost->without_kpa2, lost->losses_kpa2);
    NamedCause named = named_as(name, of);
    if (!of.is_clear(limits::least_explained_share) || !moves_the_finger(of) ||
        position_of(question_.given, named.cause))
      return;
    found.stage = lost->stage;
    found.heldout_rmse_kpa = rmse_mm(lost->losses_kpa2);
    named.parameters = parameters_of(name, found.stage, lost->parts);
    named.alternatives = {*find_cause(causes::PressureScale::id)};
    found.named.push_back(std::move(named));
    found.advice =
        "at " + significant(lost->highest_kpa, 3) + " kPa " + significant(lost->missing_kpa, 2) +
        " kPa of the command are missing in the measured pressure, for rising and falling commands. Hold "
        "full pressure and close the line after the valve. If the pressure of the finger falls, the finger "
        "leaks. If the pressure of the finger does not fall, the scale of the valve or of the pressure "
        "sensor is wrong";
  }

  [[nodiscard]] bool moves_the_finger(const PartEvidence& of) const {
    const double pressures_kpa = range_of(logs_, &Log::pressure_kpa);
    if (!(pressures_kpa > 0)) return false;
    const double gain_mm_per_kpa = range_of(logs_, &Log::displacement_mm) / pressures_kpa;
    return gain_mm_per_kpa * std::sqrt(of.gain_kpa2.value) > question_.noise_mm;
  }

  /// Returns the parameters of the part with their confidence intervals. The intervals include the
  /// uncertainty of all other fitted parameters.
  [[nodiscard]] std::vector<CauseParameter> parameters_of(const PartName& name, const ValveStage& stage,
                                                          ValveParts kept) const {
    std::vector<double ValveStage::*> numbers;
    for (const Number& number : name.numbers) numbers.push_back(number.value);
    const auto beside = [&](double ValveStage::*number, bool fitted) {
      if (fitted && std::find(numbers.begin(), numbers.end(), number) == numbers.end())
        numbers.push_back(number);
    };
    const auto has = [&](ValvePart part) { return kept.test(index_of(part)); };
    beside(&ValveStage::gauge_gain, !has(ValvePart::leak));
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
      const double value = stage.*number.value, half = limits::deviate * errors[static_cast<Eigen::Index>(i)];
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
    named.gain_percent = of.gain_percent;
    named.gain_kpa2 = of.gain_kpa2;
    named.inclusion = of.inclusion;
    return named;
  }

  const std::vector<Log>& logs_;
  const ValveQuestion& question_;
  MeasuredValve valve_;
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
    measured.push_back(thinned_log(log, stride));
    if (!log.supply_kpa.empty()) (void)smooth_input(measured.back().time_s, measured.back().supply_kpa);
  }
  const ThreadBudget budget(question.threads);
  return Search(measured, question).findings();
}

}  // namespace softgrip::sysid
