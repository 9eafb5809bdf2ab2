#include "sysid/changes/change.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/enum_table.h"
#include "base/numbers.h"
#include "base/statistics.h"
#include "base/thread_budget.h"
#include "sysid/changes/base.h"
#include "sysid/changes/change_judge.h"
#include "sysid/changes/change_warnings.h"
#include "sysid/diagnosis/causes/outliers.h"
#include "sysid/diagnosis/causes/sampling.h"
#include "sysid/diagnosis/residual/closed_loop.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/diagnosis/residual/resolution.h"
#include "sysid/diagnosis/residual/sampling.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/plausibility_warnings.h"

namespace softgrip::sysid {
namespace {

using Failure = tl::unexpected<std::string>;

struct Prepared {
  std::vector<Record> records;
  double noise_mm = 0;
  OutlierEvidence outliers = {};
  SamplingEvidence sampling = {};
};

/// Converts the logs to records. Outliers and repeated readings are excluded from the evaluation.
/// @param healthy_noise_mm  noise of the healthy logs, which is the lower limit of the noise. The noise of
/// later logs may be smaller, for example zero at the limit of a sensor. Readings within the noise of the
/// healthy logs are not outliers.
Prepared driven_records(const std::vector<Log>& logs, Drive drive, const ChangeOptions& options,
                        double healthy_noise_mm = 0) {
  Prepared p{.records = make_records(logs, {.drive = drive, .held = options.held})};
  p.sampling = hide_repeated(p.records);
  p.noise_mm = std::max(healthy_noise_mm, measured_noise_mm(p.records));
  p.outliers = hide_outliers(p.records, p.noise_mm);
  return p;
}

bool has_pressure(const std::vector<Log>& logs) {
  return std::all_of(logs.begin(), logs.end(), [](const Log& log) { return !log.pressure_kpa.empty(); });
}

std::string objection_to(const std::vector<Log>& healthy, const std::vector<Log>& later) {
  if (healthy.empty() || later.empty())
    return "The diagnosis of a change requires healthy logs and later logs";
  const auto samples = [](const std::vector<Log>& logs) {
    std::size_t sum = 0;
    for (const Log& log : logs) sum += log.size();
    return sum;
  };
  // A single log is divided into two halves.
  constexpr std::size_t fewest = 2 * limits::fewest_readings;
  if (samples(healthy) < fewest || samples(later) < fewest)
    return "The diagnosis of a change requires " + std::to_string(fewest) +
           " samples of healthy logs and as many samples of later logs";
  return {};
}

void warn(const std::vector<Log>& healthy, const std::vector<Log>& later,
          std::vector<std::string>& warnings) {
  for (const std::vector<Log>* const logs : {&healthy, &later}) {
    for (std::string& sentence : corrections_of(*logs)) warnings.push_back(std::move(sentence));
  }
  const auto among = repetition_warnings(later, healthy, "the healthy log",
                                         "The comparison of a log with itself cannot show a change");
  warnings.insert(warnings.end(), among.begin(), among.end());
  std::vector<std::string> closed;
  for (const std::vector<Log>* const logs : {&healthy, &later}) {
    for (const Log& log : *logs) {
      if (is_closed_loop(log.pressure_command_kpa, log.displacement_mm)) closed.push_back(log.name);
    }
  }
  if (!closed.empty()) warnings.push_back(closed_loops(closed));
  const double now_kpa = largest_command_kpa(later), then_kpa = largest_command_kpa(healthy);
  if (now_kpa > 1.05 * then_kpa)
    warnings.push_back(
        "The later logs reach " + significant(now_kpa, 3) + " kPa, but the healthy logs reach only " +
        significant(then_kpa, 3) +
        " kPa. Above this pressure, the baseline model extrapolates, so its prediction may be wrong");
  if (healthy.size() == 1)
    warnings.emplace_back(
        "One healthy log does not show how much healthy runs differ from each other. A change is therefore "
        "reported only if its error exceeds three times the error between the two halves of the healthy log. "
        "Before this comparison, a gain difference of up to " +
        significant(100 * usual_gain_difference, 2) +
        " % is subtracted from the displacement (more if the gains of the two halves differ by more than " +
        significant(100 * limits::usual_gain_spread, 1) +
        " %). The 95 % intervals of a change do not contain the differences between healthy runs. "
        "Record three or more healthy logs");
  if (has_pressure(healthy) != has_pressure(later))
    warnings.emplace_back(
        "pressure_kpa is recorded in only one of the two groups (healthy logs, later logs), so the valve and "
        "the finger are evaluated together");
}

/// Returns the name of the first later log whose command differs from the commands of all healthy logs.
/// Returns an empty text if there is no such log.
std::string log_with_another_command(const std::vector<Log>& healthy, const std::vector<Log>& later) {
  for (const Log& log : later) {
    if (std::none_of(healthy.begin(), healthy.end(),
                     [&](const Log& other) { return have_same_command(log, other, limits::rest_share); }))
      return log.name;
  }
  return {};
}

std::string another_command(const std::string& log) {
  return "No healthy log has the same command as " + log +
         ". The model error for another command may look like a change. To exclude this, record a later log "
         "with the command of a healthy log";
}

std::string unused_pressure(const DriveChoice& choice) {
  return "For healthy runs that were left out of the fit, the prediction from the command is better than the "
         "prediction from the measured pressure (RMS errors " +
         significant(choice.by_command_mm, 2) + " and " + significant(choice.by_pressure_mm, 2) +
         " mm), so pressure_kpa is not used";
}

/// Adds the two causes that are found in the readings without a fit: isolated wrong readings, and repeated
/// readings.
void judge_readings(const Prepared& healthy, const Prepared& later, ChangeDiagnosis& diagnosis) {
  const auto add = [&](std::string_view id, ChangeSize size, std::optional<Interval> interval,
                       double excess_mm) {
    ChangeCause cause;
    const Cause known = *find_cause(id);
    cause.id = known.id;
    cause.title = known.title;
    cause.station = known.station;
    cause.size = std::move(size);
    cause.intervals.size = interval;
    cause.effect_mm = excess_mm;
    cause.share_percent = 100;
    cause.gain = later.noise_mm > 0 ? std::pow(excess_mm / later.noise_mm, 2) : 0;
    diagnosis.causes.push_back(std::move(cause));
  };
  const OutlierEvidence& outliers = later.outliers;
  if (outliers.present && outliers.share_low > healthy.outliers.share_high)
    add(causes::Outliers::id, {"share of wrong readings", 100 * outliers.share, "%"},
        Interval{100 * outliers.share_low, 100 * outliers.share_high}, outliers.excess_mm);
  const SamplingEvidence& sampling = later.sampling;
  constexpr double slower = 1.5;
  if (sampling.present && sampling.frozen_s > slower * healthy.sampling.frozen_s)
    add(causes::Sampling::id, {"the reading is frozen for", sampling.frozen_s, "s"}, {}, sampling.excess_mm);
  else if (sampling.present && sampling.interval_s > slower * healthy.sampling.interval_s)
    add(causes::Sampling::id, {"time between two updates of the reading", sampling.interval_s, "s"}, {},
        sampling.excess_mm);
  else if (sampling.step_mm > slower * std::max(healthy.sampling.step_mm, healthy.noise_mm))
    add(causes::Sampling::id, {"resolution of the reading", sampling.step_mm, "mm"}, {},
        std::sqrt(rounding_variance_mm2(sampling.step_mm)));
}

ChangeVerdict verdict_of(const ChangeDiagnosis& d) {
  const bool left =
      std::any_of(d.readings.begin(), d.readings.end(), [](const JudgedChange& j) { return j.left_over; });
  const bool alternatives = std::any_of(d.causes.begin(), d.causes.end(),
                                        [](const ChangeCause& c) { return !c.alternatives.empty(); });
  if (d.causes.empty()) return left ? ChangeVerdict::unexplained : ChangeVerdict::unchanged;
  if (left) return ChangeVerdict::partly_explained;
  return alternatives ? ChangeVerdict::ambiguous : ChangeVerdict::cause_found;
}

tl::expected<ChangeDiagnosis, std::string> diagnose_oriented(const std::vector<Log>& healthy,
                                                             const std::vector<Log>& later,
                                                             const ChangeOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  if (const std::string objection = objection_to(healthy, later); !objection.empty())
    return Failure(objection);
  ChangeDiagnosis diagnosis;
  warn(healthy, later, diagnosis.warnings);
  const ThreadBudget budget(options.threads);
  BaseOptions base{options.given, options.seed, options.threads, options.progress};
  bool pressure = has_pressure(healthy) && has_pressure(later);
  Prepared before = driven_records(healthy, pressure ? Drive::measured : Drive::command, options);
  if (pressure) {
    Prepared commanded = driven_records(healthy, Drive::command, options);
    const DriveChoice choice = chosen_drive(before.records, commanded.records, options.seed, options.threads);
    if (choice.drive == Drive::command) {
      diagnosis.warnings.push_back(unused_pressure(choice));
      pressure = false;
      before = std::move(commanded);
    }
  }
  const Drive drive = pressure ? Drive::measured : Drive::command;
  const Prepared after = driven_records(later, drive, options, before.noise_mm);
  judge_readings(before, after, diagnosis);
  for (const Record& record : after.records)
    base.later_interval_s = std::max(base.later_interval_s, record.mean_interval_s());
  if (pressure)
    judge_change(fit_base(pressure_records(healthy, options.held), Judged::pressure, Drive::command, base),
                 true, pressure_records(later, options.held), options, diagnosis);
  judge_change(fit_base(before.records, Judged::displacement, drive, base), pressure, after.records, options,
               diagnosis);
  std::stable_sort(diagnosis.causes.begin(), diagnosis.causes.end(),
                   [](const ChangeCause& a, const ChangeCause& b) { return a.gain > b.gain; });
  diagnosis.verdict = verdict_of(diagnosis);
  if (diagnosis.verdict != ChangeVerdict::unchanged)
    diagnosis.another_command = log_with_another_command(healthy, later);
  if (!diagnosis.another_command.empty())
    diagnosis.warnings.push_back(another_command(diagnosis.another_command));
  diagnosis.output_unit = healthy.front().output_unit;
  for (ChangeCause& cause : diagnosis.causes) cause.output_unit = diagnosis.output_unit;
  for (ChangeCause& cause : diagnosis.partial) cause.output_unit = diagnosis.output_unit;
  for (JudgedChange& judged : diagnosis.readings) judged.output_unit = diagnosis.output_unit;
  diagnosis.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return diagnosis;
}

}  // namespace

bool ChangeCause::lists(std::string_view any_id) const {
  return id == any_id || std::count(alternatives.begin(), alternatives.end(), any_id) > 0;
}

double share_explained(const JudgedChange& judged) {
  const double excess_mm2 = square(judged.later_mm) - square(judged.healthy_mm);
  const double excess_loss = judged.loss_before - 1;
  const double plain =
      excess_mm2 > 0 ? (square(judged.later_mm) - square(judged.explained_mm)) / excess_mm2 : 0;
  const double white = excess_loss > 0 ? (judged.loss_before - judged.loss_left) / excess_loss : 0;
  return std::clamp(std::max(plain, white), 0.0, 1.0);
}

std::string_view name_of(ChangeVerdict verdict) {
  static constexpr auto names = enum_names<ChangeVerdict>({
      {ChangeVerdict::unchanged, "unchanged"},
      {ChangeVerdict::cause_found, "cause_found"},
      {ChangeVerdict::ambiguous, "ambiguous"},
      {ChangeVerdict::partly_explained, "partly_explained"},
      {ChangeVerdict::unexplained, "unexplained"},
  });
  return names[verdict];
}

tl::expected<ChangeDiagnosis, std::string> diagnose_change(const std::vector<Log>& healthy,
                                                           const std::vector<Log>& later,
                                                           const ChangeOptions& options) {
  const Orientation orientation = orientation_of(healthy);
  if (!orientation.is_mirrored()) return diagnose_oriented(healthy, later, options);
  ChangeOptions without_given = options;
  without_given.given.reset();
  auto diagnosis =
      diagnose_oriented(oriented(healthy, orientation), oriented(later, orientation), without_given);
  if (!diagnosis) return diagnosis;
  diagnosis->orientation = orientation;
  diagnosis->warnings.insert(diagnosis->warnings.begin(), sentence_of(orientation));
  return diagnosis;
}

}  // namespace softgrip::sysid
