#include "sysid/diagnosis/verdict/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/causes/outliers.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/residual/leftover.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/diagnosis/search/coherence.h"
#include "sysid/diagnosis/search/staircase_selection.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr double clearly_correlated = 0.05;
constexpr double block_s = 8;
constexpr std::size_t fewest_samples = 200;
/// What a staircase may leave of the mean square that stood without it: courses of tiny steps nibble at
/// anything.
constexpr double left_by_staircase = 0.25;

double square(double x) {
  return x * x;
}

/// What recalibration cannot be trusted with.
void warn_unphysical(const model::Model& model, std::vector<std::string>& warnings) {
  if (const double ratio = beta_over_gain(model); ratio > 1)
    warnings.push_back("recalibrated, the model is unphysical: " + wrong_way_sentence(ratio));
}

/// Which causes cannot be judged without a column.
void warn_of_columns(const Scales& scales, std::vector<std::string>& warnings) {
  for (const Column column : {Column::temperature_c, Column::supply_kpa}) {
    std::string ids;
    for (const Cause& cause : all_causes()) {
      if (cause.needs == column) ids += (ids.empty() ? "" : " and ") + std::string(cause.id);
    }
    if (!scales.has(column) && !ids.empty()) {
      warnings.push_back("no " + std::string(name_of(column)) + " column that varies: " + ids +
                         " cannot be judged");
    }
  }
}

/// Limits of the data that bear on what can be told.
void warn_of_data(const std::vector<Log>& logs, const Scales& scales, std::vector<std::string>& warnings) {
  warn_of_columns(scales, warnings);
  const bool measured =
      std::any_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
  if (!measured) {
    warnings.emplace_back(
        "commanded pressure only: what the valve does and what the actuator does are told apart by "
        "their nonlinearity alone");
  }
  std::vector<double> peaks;
  bool unloads = false, rests = false;
  for (const Log& log : logs) {
    const std::vector<double>& u = log.pressure_command_kpa;
    double top = u.front();
    for (std::size_t i = 1; i < u.size(); ++i) {
      top = std::max(top, u[i]);
      unloads |= u[i] < top - 0.2 * scales.largest_kpa;
      if (i + 1 < u.size() && u[i] > u[i - 1] && u[i] >= u[i + 1]) peaks.push_back(u[i]);
    }
    double still_s = 0;
    for (std::size_t i = 1; i < u.size(); ++i) {
      const bool still = std::abs(u[i]) < 0.02 * scales.largest_kpa && std::abs(u[i] - u[i - 1]) < 1e-6;
      still_s = still ? still_s + log.time_s[i] - log.time_s[i - 1] : 0;
      rests |= still_s > 3;
    }
  }
  if (!unloads) warnings.emplace_back("unloading never seen: hysteresis cannot be judged");
  if (!rests)
    warnings.emplace_back("no rest at zero pressure: creep, softening and drift are hard to tell apart");
  if (!peaks.empty()) {
    const auto [low, high] = std::minmax_element(peaks.begin(), peaks.end());
    if (*high - *low < 0.05 * scales.largest_kpa) {
      warnings.emplace_back("one amplitude only: what depends on amplitude cannot be judged");
    }
  }
}

/// The base fitted from the given model and, since recalibration can start far off, from the data's scale.
tl::expected<StructureFit, std::string> recalibrate(const SearchData& data, const DiagnosisOptions& options) {
  StructureFit best = fit_structure(data.records, {}, data.given);
  IdentifyOptions wide;
  wide.starts = 6;
  wide.seed = options.seed;
  wide.threads = options.threads;
  wide.record = options.record;
  auto found = identify(data.records, data.given.model, wide);
  if (found) {
    FitPoint point{found->fitted, rest_starts(found->fitted, data.records)};
    // What identification found out about unknown starts.
    for (std::size_t k = 0; k < data.records.size(); ++k) point.starts[k] = found->scores[k].start;
    StructureFit other = fit_structure(data.records, {}, point);
    if (other.mean_square_mm2 < best.mean_square_mm2 * (1 - 1e-4)) best = std::move(other);
  }
  if (!std::isfinite(best.mean_square_mm2)) return Failure("the model's answer to these logs is not finite");
  return best;
}

std::vector<CauseParameter> parameters_of(const StructureFit& fit, const Cause& cause, const FitSpace& space,
                                          const std::vector<double>& z, const Uncertainty& uncertainty) {
  std::vector<CauseParameter> list;
  const auto position = position_of(fit.point.model, cause);
  const model::BlockSpec& block = fit.point.model.blocks[*position];
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    CauseParameter p;
    p.name = model::parameter_name(block, i);
    p.unit = std::string(model::catalogue()[block.type].spec(i).unit);
    p.value = block.values[i];
    for (std::size_t j = 0; j < space.size(); ++j) {
      const FreeParameter& free = space.free()[j];
      if (free.kind != FreeParameter::Kind::model) continue;
      const model::ParameterPlace place = model::place_of(fit.point.model, free.flat_index);
      if (place.block != *position || place.value != i) continue;
      const auto at = static_cast<Eigen::Index>(j);
      const double deviation = std::sqrt(std::max(0.0, uncertainty.covariance(at, at)));
      if (deviation == 0 || uncertainty.at_bound[j]) continue;
      const double half = uncertainty.quantile * deviation;
      p.ci95 = {free.to_value(z[j] - half), free.to_value(z[j] + half)};
      p.has_interval = true;
    }
    list.push_back(std::move(p));
  }
  return list;
}

NamedCause outlier_cause(const OutlierEvidence& evidence, double noise_mm) {
  NamedCause named;
  named.cause = *find_cause(causes::Outliers::id);
  named.block_type = named.cause.forms.front().type;
  named.parameters = {
      {"probability", "", evidence.share, {evidence.share_low, evidence.share_high}, true},
      {"size_mm", "mm", evidence.size_mm, {evidence.size_low_mm, evidence.size_high_mm}, true}};
  const double with = std::sqrt(square(noise_mm) + square(evidence.excess_mm));
  const double gain = 100 * (1 - noise_mm / with);
  const double relative = 1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, evidence.count)));
  named.heldout_gain_percent = {gain, gain * relative / 2, gain * (1 - relative), gain * (1 + relative)};
  return named;
}

class Diagnostician {
 public:
  Diagnostician(const std::vector<Log>& logs, const model::Model& given, const DiagnosisOptions& options)
      : logs_(logs), given_(given), options_(options) {}

  tl::expected<Diagnosis, std::string> run() {
    StageClock clock(d_);
    if (auto ready = prepare(); !ready) return Failure(ready.error());
    auto base = recalibrate(data_, options_);
    if (!base) return Failure(base.error());
    hide_more_outliers(*base);
    d_.recalibrated = *base;
    if (const auto wrong = why_not_about(data_.records, *base)) return Failure(*wrong);
    data_.scales.residual_lines = spectrum_peaks(data_.records, base->residual_mm, 3);
    clock.ended("recalibration");
    const Division division = divide(data_.records, block_s);
    SelectionOptions selection_options;
    selection_options.seed = options_.seed;
    selection_options.progress = options_.progress;
    if (left_by_outliers(structure_of(base->residual_mm, d_.noise_mm))) selection_options.most_causes = 0;
    Selection selection = select_causes(data_, std::move(*base), d_.noise_mm, division, selection_options);
    clock.ended("search");
    if (leaves_too_much(selection) && look_for_staircase(selection, division)) clock.ended("staircase");
    if (options_.gauge) {
      const GaugeQuestion question{*options_.gauge, d_.noise_mm, options_.seed, !d_.staircase};
      d_.gauge = weigh_gauge(question, data_, division, selection, d_.warnings);
      clock.ended("gauge");
    }
    measure(selection, division);
    if (options_.null_campaigns > 0 && !selection.chosen.empty()) calibrate(division);
    if (d_.null_calibration) clock.ended("nulls");
    name(selection);
    conclude(selection);
    clock.ended("held-out logs and intervals");
    if (d_.verdict == Verdict::unexplained) {
      if (auto strangers = strangers_among(data_.records, d_.recalibrated)) {
        d_.warnings.push_back(*strangers);
      } else if (!d_.null_calibration && look_for_base(selection)) {
        clock.ended("base");
      }
    }
    return std::move(d_);
  }

 private:
  tl::expected<void, std::string> prepare() {
    std::vector<Record> records = make_records(logs_, options_.record);
    std::size_t readings = 0;
    for (const Record& record : records) readings += record.readings;
    if (readings < fewest_samples) {
      return Failure("only " + std::to_string(readings) +
                     " readings in all: too few to tell a cause from noise (" +
                     std::to_string(fewest_samples) + " are needed)");
    }
    // The zero of the first log may be anywhere; that it moves from log to log is a drift, which is a cause.
    const bool zero_free = records.front().offset_free && !records.front().start_unknown;
    for (Record& record : records) record.offset_free = zero_free || record.start_unknown;
    d_.noise_mm = measured_noise_mm(records);
    if (d_.noise_mm <= 0) return Failure("the readings have no noise at all: this is not measured data");
    d_.outliers = hide_outliers(records, d_.noise_mm);
    use(std::move(records));
    warn_of_data(logs_, data_.scales, d_.warnings);
    return {};
  }

  void use(std::vector<Record> records) {
    data_ = make_search_data(std::move(records), deterministic_part(given_, options_.record.drive));
    data_.threads = options_.threads;
    data_.scales.has_valve = options_.record.drive == Drive::command;
    d_.records = data_.records;
    d_.as_given = evaluate_structure(data_.records, {}, data_.given);
    d_.as_given_rmse_mm = std::sqrt(d_.as_given.mean_square_mm2);
  }

  /// With a recalibrated model outliers stand out in the midst of a motion too; without them it fits better,
  /// and may show more.
  void hide_more_outliers(StructureFit& base) {
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<Record> records = data_.records;
      if (hide_outliers_beside(records, base.residual_mm, d_.noise_mm, d_.outliers) == 0) return;
      use(std::move(records));
      base = fit_structure(data_.records, {}, base.point);
    }
  }

  /// Whether a selection leaves more than what is named may leave, or structure where nothing is named.
  [[nodiscard]] bool leaves_too_much(const Selection& selection) const {
    if (!selection.left.present) return false;
    if (selection.chosen.empty()) {
      return !left_by_outliers(selection.left) && selection.left.excess_mm > 0.2 * d_.noise_mm;
    }
    return sysid::leaves_too_much(selection.left, selection.base_structure, d_.noise_mm);
  }

  /// A valve that sticks leaves what no simulation from the command alone can foretell. True where that is
  /// what was missing; the selection is then the one behind the staircase.
  bool look_for_staircase(Selection& selection, const Division& division) {
    if (options_.record.drive != Drive::command) return false;
    if (options_.progress) options_.progress("looks for a staircase");
    SelectionOptions one_more;
    one_more.most_causes = 1;
    one_more.seed = options_.seed;
    one_more.progress = options_.progress;
    auto found = select_behind_staircase(data_, selection, d_.noise_mm, division, one_more);
    if (!found || leaves_too_much(found->selection)) return false;
    if (square(found->selection.left.excess_mm) > left_by_staircase * square(selection.left.excess_mm))
      return false;
    selection = std::move(found->selection);
    d_.staircase = found->evidence;
    return true;
  }

  /// Where no cause on the given base explains the data, the base itself may be the finding.
  bool look_for_base(const Selection& selection) {
    const BaseQuestion question{options_.record.drive, d_.noise_mm, options_.seed, options_.threads,
                                options_.progress};
    auto found = find_base(data_, selection.base, selection.extended, question);
    if (!found) return false;
    d_.base = found->description;
    d_.extended = std::move(found->fit);
    d_.recalibrated_rmse_mm = rmse_mm(found->recalibrated_losses);
    d_.extended_rmse_mm = rmse_mm(found->losses);
    d_.extended_other_logs_rmse_mm.reset();
    d_.recalibrated_other_logs_rmse_mm.reset();
    d_.gain = gain_percent(found->recalibrated_losses, found->losses, options_.seed);
    d_.structure_left = structure_of(d_.extended.residual_mm, d_.noise_mm);
    d_.unexplained_percent =
        std::min(100.0, 100 * square(d_.structure_left.excess_mm / selection.base_structure.excess_mm));
    model::Model model = d_.extended.point.model;
    // For the daemon, which commands: what the valve does stands in front again.
    if (options_.record.drive == Drive::measured)
      model = with_valve(std::move(model), fit_valve_stage(logs_, 1, options_.record.held));
    d_.extended_model = named_model(std::move(model), "extended");
    d_.causes = std::move(found->named);
    d_.partial = std::move(found->possible);
    const bool rivals = std::any_of(d_.causes.begin(), d_.causes.end(),
                                    [](const NamedCause& c) { return !c.rivals.empty(); });
    const bool whole = !sysid::leaves_too_much(d_.structure_left, selection.base_structure, d_.noise_mm);
    if (!d_.causes.empty()) {
      d_.verdict = !whole ? Verdict::partly_explained : rivals ? Verdict::ambiguous : Verdict::cause_found;
    }
    return true;
  }

  void measure(const Selection& selection, const Division& division) {
    d_.extended = selection.extended;
    d_.structure_recalibrated = selection.base_structure;
    d_.structure_left = selection.left;
    d_.recalibrated_rmse_mm = rmse_mm(selection.base_losses);
    d_.extended_rmse_mm = rmse_mm(selection.extended_losses);
    d_.gain = gain_percent(selection.base_losses, selection.extended_losses, options_.seed);
    d_.rejected = selection.last_candidates;
    recalibration_gain_ =
        mean_difference(losses_of(d_.as_given, division), selection.base_losses, options_.seed);
    d_.unexplained_percent =
        selection.base_structure.excess_mm > 0
            ? std::min(100.0, 100 * square(selection.left.excess_mm / selection.base_structure.excess_mm))
            : 0;
    if (!selection.left.present && !selection.base_structure.present) d_.unexplained_percent = 0;
    if (data_.records.size() > 1) {
      const Division logs = divide_by_record(data_.records);
      d_.recalibrated_other_logs_rmse_mm = rmse_mm(held_out_losses(data_.records, logs, selection.base));
      if (!selection.chosen.empty()) {
        d_.extended_other_logs_rmse_mm = rmse_mm(held_out_losses(data_.records, logs, selection.extended));
      }
    }
    d_.recalibrated_model = named_model(selection.base.point.model, "recalibrated");
    d_.extended_model = named_model(selection.extended.point.model, "extended");
    warn_unphysical(d_.recalibrated_model, d_.warnings);
  }

  void calibrate(const Division& division) {
    NullOptions nulls;
    nulls.campaigns = options_.null_campaigns;
    nulls.seed = options_.seed;
    if (options_.progress) {
      nulls.progress = [&](std::size_t done) {
        options_.progress("null campaign " + std::to_string(done) + " of " +
                          std::to_string(options_.null_campaigns));
      };
    }
    d_.null_calibration = calibrate_on_nulls(data_, d_.recalibrated, d_.gain.value, division, nulls);
  }

  [[nodiscard]] model::Model named_model(model::Model model, const std::string& how) const {
    model.name = given_.name;
    std::string files;
    for (const Log& log : logs_) files += (files.empty() ? "" : ", ") + log.name;
    model.source = how + " by softgrip diagnose from " + files + "; before: " + given_.source;
    return model;
  }

  void name(const Selection& selection) {
    if (d_.outliers.present) causes_.push_back(outlier_cause(d_.outliers, d_.noise_mm));
    if (selection.chosen.empty()) return;
    const FitSpace space =
        structure_space(data_.records, selection.extended.point.model, selection.extended.causes);
    const auto residuals = residuals_for(data_.records, space);
    const std::vector<double> z = space.z(selection.extended.point);
    const Uncertainty uncertainty = uncertainty_at(*residuals, z, std::numeric_limits<double>::infinity());
    for (const ChosenCause& chosen : selection.chosen) {
      NamedCause named;
      named.cause = chosen.cause;
      const model::Model& extended = selection.extended.point.model;
      named.block_type = extended.blocks[*position_of(extended, chosen.cause)].type;
      named.parameters = parameters_of(selection.extended, chosen.cause, space, z, uncertainty);
      if (d_.staircase && chosen.cause.id == causes::ValveDeadband::id) {
        // Of the staircase itself; the extended model's may be that of its mean.
        named.parameters.front() = {"band_kpa", "kPa", d_.staircase->band_kpa, d_.staircase->band_ci95, true};
      }
      named.heldout_gain_percent = chosen.gain_percent;
      named.gain_mm2 = chosen.gain_mm2;
      named.inclusion = chosen.inclusion;
      named.rivals = chosen.rivals;
      named.candidates = chosen.candidates;
      causes_.push_back(std::move(named));
    }
  }

  /// Wrong samples that were not found stand alone; what a cause does resembles itself from sample to sample.
  [[nodiscard]] bool left_by_outliers(const Structure& structure) const {
    return d_.outliers.present && structure.slow_correlation <= clearly_correlated &&
           structure.excess_mm < d_.noise_mm;
  }

  void conclude(const Selection& selection) {
    // Where the gauge has told which of two twins it is, how well the form of that one fits is beside the
    // point.
    const bool placed_by_gauge = d_.gauge && d_.gauge->replaced;
    const bool too_much_left = !placed_by_gauge && leaves_too_much(selection);
    const bool by_chance = d_.null_calibration && d_.null_calibration->reach_the_gain();
    if (!selection.chosen.empty() && (too_much_left || by_chance)) {
      d_.verdict = Verdict::unexplained;
      d_.partial = std::move(causes_);
      d_.extended_model =
          by_chance ? d_.recalibrated_model : named_model(selection.extended.point.model, "extended in part");
      return;
    }
    if (selection.chosen.empty() && too_much_left) {
      d_.verdict = Verdict::unexplained;
      d_.partial = std::move(causes_);
      d_.unexplained_percent = 100;
      return;
    }
    d_.causes = std::move(causes_);
    if (d_.outliers.present && selection.chosen.empty()) {
      const double left = square(selection.left.excess_mm);
      d_.unexplained_percent =
          selection.left.present ? 100 * left / (left + square(d_.outliers.excess_mm)) : 0;
    }
    if (!d_.causes.empty()) {
      const bool rivals = std::any_of(d_.causes.begin(), d_.causes.end(),
                                      [](const NamedCause& c) { return !c.rivals.empty(); });
      d_.verdict = rivals ? Verdict::ambiguous : Verdict::cause_found;
      return;
    }
    const bool better =
        recalibration_gain_.lower > 0 && recalibration_gain_.value > 0.01 * square(d_.noise_mm);
    d_.verdict = better ? Verdict::recalibrate : Verdict::adequate;
  }

  const std::vector<Log>& logs_;
  const model::Model& given_;
  const DiagnosisOptions& options_;
  SearchData data_;
  Spread recalibration_gain_;
  std::vector<NamedCause> causes_;
  Diagnosis d_;
};

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::adequate:
      return "adequate";
    case Verdict::recalibrate:
      return "recalibrate";
    case Verdict::cause_found:
      return "cause_found";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::partly_explained:
      return "partly_explained";
    case Verdict::unexplained:
      return "unexplained";
  }
  return "unexplained";
}

void examine(Diagnosis& d, const DiagnosisOptions& options) {
  StageClock clock(d);
  d.evidence = examine_fits(d.records, d.as_given, d.recalibrated, d.extended, d.noise_mm, options.seed);
  clock.ended("evidence");
}

tl::expected<Diagnosis, std::string> diagnose(const std::vector<Log>& logs, const model::Model& given,
                                              const DiagnosisOptions& options) {
  if (logs.empty()) return Failure("no logs to diagnose");
  return Diagnostician(logs, given, options).run();
}

}  // namespace softgrip::sysid
