#include "sysid/changes/base.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/parallel.h"
#include "base/statistics.h"
#include "model/catalogue.h"
#include "sysid/changes/downstream.h"
#include "sysid/changes/echo_fit.h"
#include "sysid/changes/regulator_fit.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/resampled_record.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_fit.h"
#include "sysid/structure/structure_model.h"

namespace softgrip::sysid {
namespace {

/// A valve answers sooner than a finger: whatever the command drives is judged in shorter bins, and so is a
/// finger's own delay told from its lag.
constexpr double shortest_finger_bin_s = 0.05, shortest_commanded_bin_s = 0.02;
/// In bins, of what is left; of a finger, which forgets later than a valve, so many seconds where that is
/// more.
constexpr std::size_t whitening_order = 8;
constexpr double finger_memory_s = 0.4;
/// From day to day no gain and no zero stays nearer than this.
constexpr double least_gain_spread = 0.002;
constexpr double least_zero_share = 0.0005;

/// A model that may be the base, with the starts of the healthy records.
struct Choice {
  std::string description;
  FitPoint point;
  std::optional<Regulator> regulator = {};
};

std::vector<Record> behind(const std::optional<Regulator>& regulator, const std::vector<Record>& records) {
  if (!regulator) return records;
  std::vector<Record> driven;
  driven.reserve(records.size());
  for (const Record& record : records) driven.push_back(behind(*regulator, record));
  return driven;
}

double mean_temperature(const std::vector<Record>& records) {
  double sum = 0, count = 0;
  for (const Record& record : records) {
    for (const double t : record.temperature_c) {
      sum += t;
      count += 1;
    }
  }
  return count > 0 ? sum / count : 20;
}

/// Of a pressure: what a regulator makes of the command, which drives the record; without one nothing.
std::vector<double> without_model(const std::optional<Regulator>& regulator, const Record& driven) {
  return regulator ? driven.drive_kpa : std::vector<double>(driven.size(), 0.0);
}

std::vector<double> plain_prediction(const model::Model& model, const std::optional<Regulator>& regulator,
                                     const Record& record) {
  if (model.blocks.empty()) return without_model(regulator, record);
  return predict(model, record, rest_starts(model, {record}).front());
}

std::vector<double> started_prediction(const Choice& choice, const std::vector<Record>& records,
                                       std::size_t r) {
  if (choice.point.model.blocks.empty()) return without_model(choice.regulator, records[r]);
  return predict(choice.point.model, records[r], choice.point.starts[r]);
}

/// What a choice leaves of its records, in bins.
Binned left_by(const Choice& choice, const std::vector<Record>& records, double bin_s) {
  Binned left;
  for (std::size_t r = 0; r < records.size(); ++r)
    left.push_back(binned(records[r], residual(records[r], started_prediction(choice, records, r)), bin_s));
  return left;
}

std::vector<Choice> choices(const std::vector<Record>& records, const Base& base,
                            const BaseOptions& options) {
  if (base.judged == Judged::pressure) return {{"filter bank", {}}};
  const bool command = base.drive == Drive::command;
  const BaseStructure play{.hysteresis = HysteresisForm::play, .delay = command, .hinged_creep = true};
  std::vector<std::function<Choice()>> makes{
      [&] {
        const FittedStructure fit = fit_form(records, play, grid_for(records), {});
        return Choice{description_of(play), point_of(fit, records, base.drive)};
      },
      [&] {
        return Choice{"Bouc-Wen and two creep branches",
                      fit_published(records, base.drive, 6, options.seed).point};
      }};
  if (command) {
    makes.emplace_back([&] {
      const Regulator regulator = fit_regulator(records, base.largest_kpa);
      const std::vector<Record> driven = behind(regulator, records);
      const FittedStructure fit = fit_form(driven, play, grid_for(driven), {});
      return Choice{"a regulator, " + description_of(play), point_of(fit, driven, base.drive), regulator};
    });
  }
  if (options.given) {
    makes.emplace_back([&] {
      const model::Model model = deterministic_part(*options.given, base.drive);
      return Choice{"the given model", {model, rest_starts(model, records)}};
    });
  }
  std::vector<Choice> made(makes.size());
  parallel_for(makes.size(), options.threads, [&](std::size_t i) { made[i] = makes[i](); });
  return made;
}

/// Behind a valve whose pressure is not recorded, a finger shows what either of them does.
std::vector<EchoKind> kinds_for(Judged judged, Drive drive) {
  if (judged == Judged::pressure) return {EchoKind::valve};
  if (drive == Drive::measured) return {EchoKind::finger};
  return {EchoKind::finger, EchoKind::valve_and_finger};
}

/// The choices that follow the same drives, and what each leaves of the records; one behind a regulator of
/// its own is alone.
struct AlikeDriven {
  std::vector<Record> records;
  std::vector<std::size_t> choices;
  std::vector<Binned> left;
};
std::vector<AlikeDriven> alike_driven(const std::vector<Choice>& all, const std::vector<Record>& records,
                                      double bin_s) {
  std::vector<AlikeDriven> groups{{records, {}, {}}};
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c].regulator) groups.push_back({behind(all[c].regulator, records), {}, {}});
    AlikeDriven& group = all[c].regulator ? groups.back() : groups.front();
    group.choices.push_back(c);
    group.left.push_back(left_by(all[c], group.records, bin_s));
  }
  return groups;
}

/// Of these the choice that leaves least with an echo beside it, the first of those that leave as little;
/// none where the base that there is leaves no more.
/// @param share  what a choice may leave of what the base does.
void choose(Base& base, const std::vector<Choice>& all, const std::vector<Record>& records,
            const BaseOptions& options, double share = 1) {
  const std::vector<EchoKind> kinds = kinds_for(base.judged, base.drive);
  const std::vector<AlikeDriven> groups = alike_driven(all, records, base.bin_s);
  std::vector<std::vector<FittedEcho>> fits(all.size(), std::vector<FittedEcho>(kinds.size()));
  parallel_for(groups.size() * kinds.size(), options.threads, [&](std::size_t task) {
    const auto& [driven, members, left] = groups[task / kinds.size()];
    if (members.empty()) return;
    const std::size_t k = task % kinds.size();
    std::vector<FittedEcho> fitted = fit_echo(driven, kinds[k], base.bin_s, base.largest_kpa, left);
    for (std::size_t i = 0; i < members.size(); ++i) fits[members[i]][k] = std::move(fitted[i]);
  });
  for (std::size_t c = 0; c < all.size(); ++c) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      FittedEcho& echo = fits[c][k];
      if (!(echo.left_mm < share * base.left_mm)) continue;
      base.model = all[c].point.model;
      base.regulator = all[c].regulator;
      base.description = all[c].description;
      base.kind = kinds[k];
      base.echo_weights = std::move(echo.weights);
      base.left_mm = echo.left_mm;
      base.left = std::move(echo.left);
    }
    if (options.progress) options.progress(all[c].description);
  }
}

/// Filters say exactly what a dead time below a sample does, a regulator does not. It is a pressure's base
/// where they miss what a regulator does: of a valve that is a delay and a lag they left up to 2.9 times the
/// noise, of one by ISO 6358 3.2 times and more (changed worlds of --first-seed 20261211 and 20261218).
void choose_regulator(Base& base, const std::vector<Record>& records, const BaseOptions& options) {
  constexpr double filters_miss = 3, regulator_share = 0.9;
  if (!(base.left_mm > filters_miss * base.noise_mm)) return;
  const Choice choice{"a regulator", {}, fit_regulator(records, base.largest_kpa, ReadBy::gauge)};
  choose(base, {choice}, records, options, regulator_share);
}

std::size_t order_for(const Base& base) {
  if (base.judged == Judged::pressure) return whitening_order;
  return std::max(whitening_order, static_cast<std::size_t>(std::lround(finger_memory_s / base.bin_s)));
}

/// How far gain and zero of the healthy logs differ from log to log.
void spread(Base& base) {
  double gains = 0, zeros = 0, count = 0;
  for (std::size_t r = 0; r < base.records.size(); ++r) {
    const std::vector<double> motion =
        binned(base.records[r], predict_base(base, base.records[r], {}), base.bin_s);
    PairSums sums;
    for (std::size_t b = 0; b < std::min(motion.size(), base.left[r].size()); ++b)
      sums.add(motion[b], base.left[r][b]);
    if (sums.count < 10) continue;
    const double slope = sums.covariance() / std::max(sums.variance_x(), 1e-12);
    gains += slope * slope;
    zeros += std::pow(sums.y / sums.count, 2);
    count += 1;
  }
  base.gain_spread = std::max(least_gain_spread, count > 0 ? std::sqrt(gains / count) : 0);
  base.zero_spread_mm = std::max(least_zero_share * base.span_mm, count > 0 ? std::sqrt(zeros / count) : 0);
}

std::vector<double> walked_with(const Driven& driven, const std::vector<model::BlockSpec>& blocks) {
  model::Model model = driven.model;
  for (const model::BlockSpec& block : blocks) model = model::with_block(std::move(model), block);
  return plain_prediction(model, {}, driven.walked);
}

/// Model and echo with the blocks of an extension. What stands behind the model acts on the echo, too; the
/// model is walked anew only where they reach into it or look at the way to a sample.
std::vector<double> extended_prediction(const Driven& driven, const std::vector<model::BlockSpec>& blocks) {
  std::vector<model::BlockSpec> within, behind;
  for (const model::BlockSpec& block : blocks) {
    const bool is_behind = !driven.model.blocks.empty() && block.type > driven.model.blocks.back().type;
    (is_behind ? behind : within).push_back(block);
  }
  std::stable_sort(behind.begin(), behind.end(),
                   [](const model::BlockSpec& a, const model::BlockSpec& b) { return a.type < b.type; });
  const std::vector<double> plain = within.empty() ? driven.plain : walked_with(driven, within);
  std::vector<double> with_echo(plain.size());
  std::transform(plain.begin(), plain.end(), driven.echo.begin(), with_echo.begin(), std::plus());
  if (behind.empty()) return with_echo;
  with_echo = downstream(behind, driven.walked, std::move(with_echo));
  if (is_downstream(behind, driven.model, driven.walked)) return with_echo;
  // Between samples only the model's own way is known: the echo's goes straight.
  const std::vector<double> without_echo = downstream(behind, driven.walked, plain);
  std::vector<double> exact = walked_with(driven, blocks);
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i] += with_echo[i] - without_echo[i];
  return exact;
}

std::vector<double> driven_prediction(const Base& base, const Driven& driven, const Extension& extension) {
  const Record& record = driven.record;
  std::vector<double> y = extended_prediction(driven, extension.chain);
  if (extension.crescent.share != 0) {
    const std::vector<double> loop = added_by(extension.crescent, record, base.largest_kpa);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += base.span_mm * loop[i];
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double warmer = record.temperature_c.empty() ? 0 : record.temperature_c[i] - base.temperature_c;
    y[i] *= extension.gain * (1 + (base.gain_per_c + extension.gain_per_c) * warmer);
  }
  if (extension.softening.share != 0) {
    const std::vector<double> factor = softened(extension.softening, record, base.largest_kpa);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= factor[i];
  }
  if (base.judged == Judged::pressure)
    y = pressure_behind(extension.line, extension.loss, record, std::move(y));
  return y;
}

/// What the base's regulator, if it has one, makes of a command behind these blocks. A command that bends
/// between the samples is followed there.
std::vector<double> drive_of(const Base& base, const Record& record,
                             const std::vector<model::BlockSpec>& valve, const RegulatorFault& fault) {
  if (!base.regulator) return drive_behind(valve, record);
  Regulator regulator = *base.regulator;
  regulator.leak_per_s += fault.leak_per_s;
  regulator.tube_per_s *= 1 - fault.blocked;
  if (valve.empty()) return regulated(regulator, record, record.drive_kpa);
  constexpr std::size_t parts = 5;
  Record fine = finer_record(record, parts);
  fine.drive_kpa = drive_behind(valve, fine);
  fine.held = false;
  fine.drive_kpa = regulated(regulator, fine, fine.drive_kpa);
  std::vector<double> drive_kpa(record.size());
  for (std::size_t i = 0; i < drive_kpa.size(); ++i) drive_kpa[i] = fine.drive_kpa[i * parts];
  return drive_kpa;
}

}  // namespace

Driven driven_by(const Base& base, const Record& record, const std::vector<model::BlockSpec>& valve,
                 const RegulatorFault& fault) {
  Driven driven{record, {}, base.model, {}, {}};
  if (base.regulator || !valve.empty()) {
    driven.record.drive_kpa = drive_of(base, record, valve, fault);
    driven.record.held = false;
  }
  const bool is_walked_whole = base.drive == Drive::command && !base.regulator && !base.model.blocks.empty();
  const auto whole = is_walked_whole ? with_valve(base.model, valve) : std::nullopt;
  if (whole) driven.model = *whole;
  driven.walked = whole ? record : driven.record;
  driven.echo =
      weighted_echo(driven.record, driven.record.drive_kpa, base.kind, base.largest_kpa, base.echo_weights);
  driven.plain = plain_prediction(driven.model, base.regulator, driven.walked);
  return driven;
}

std::vector<double> predict_base(const Base& base, const Record& record, const Extension& extension,
                                 const Driven* driven) {
  if (driven != nullptr && extension.valve.empty() && extension.fault == RegulatorFault{})
    return driven_prediction(base, *driven, extension);
  return driven_prediction(base, driven_by(base, record, extension.valve, extension.fault), extension);
}

Record thinned_for(const Base& base, const Record& record) {
  // A hundredth of a second in a finger's bins, whatever drives it: what rings or lags by less is told by
  // how.
  constexpr double commanded_parts = 2, measured_parts = 5, valve_parts = 4;
  const double finger_parts = base.drive == Drive::measured ? measured_parts : commanded_parts;
  return thinned_to_centres(record,
                            base.bin_s / (base.judged == Judged::pressure ? valve_parts : finger_parts));
}

std::vector<std::vector<double>> residuals_of(const Base& base, const std::vector<Record>& records) {
  std::vector<std::vector<double>> left;
  left.reserve(records.size());
  for (const Record& record : records) left.push_back(residual(record, predict_base(base, record, {})));
  return left;
}

Base fit_base(const std::vector<Record>& records, Judged judged, Drive drive, const BaseOptions& options) {
  Base base;
  base.judged = judged;
  base.drive = drive;
  base.bin_s = bin_s(records, drive == Drive::command ? shortest_commanded_bin_s : shortest_finger_bin_s);
  base.temperature_c = mean_temperature(records);
  for (const Record& record : records) {
    base.largest_kpa = std::max(base.largest_kpa, record.largest_kpa);
    base.span_mm = std::max(base.span_mm, record.span_mm);
    base.noise_mm = std::max(base.noise_mm, fast_noise_mm(record));
  }
  base.left_mm = std::numeric_limits<double>::infinity();
  choose(base, choices(records, base, options), records, options);
  if (base.judged == Judged::pressure) choose_regulator(base, records, options);
  Binned haste;
  for (const Record& record : records) haste.push_back(haste_of(record, base.bin_s));
  base.whitener = whitener_of(base.left, haste, order_for(base));
  for (const Record& record : records) base.records.push_back(thinned_for(base, record));
  spread(base);
  return base;
}

std::vector<Record> pressure_records(const std::vector<Log>& logs, bool held) {
  std::vector<Log> swapped = logs;
  for (Log& log : swapped) log.displacement_mm = log.pressure_kpa;
  return make_records(swapped, {.drive = Drive::command, .held = held});
}

}  // namespace softgrip::sysid
