#include "sysid/changes/base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "base/parallel.h"
#include "base/statistics.h"
#include "model/catalogue.h"
#include "sysid/changes/downstream.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/centred_record.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_fit.h"
#include "sysid/structure/structure_model.h"

namespace softgrip::sysid {
namespace {

constexpr std::array ridges{1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
/// Held out in turn, in blocks, fewer seconds where there are few. Shorter than what a finger remembers, a
/// block is known from its neighbours, and a slow echo that has merely learnt the order of the healthy logs
/// by heart passes: on the next day it is a zero that wanders.
constexpr double longest_block_s = 10;
constexpr std::size_t folds = 8;
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

std::vector<double> plain_prediction(const model::Model& model, const Record& record) {
  if (model.blocks.empty()) return std::vector<double>(record.size(), 0.0);
  return predict(model, record, rest_starts(model, {record}).front());
}

std::vector<double> started_prediction(const Choice& choice, const std::vector<Record>& records,
                                       std::size_t r) {
  if (choice.point.model.blocks.empty()) return std::vector<double>(records[r].size(), 0.0);
  return predict(choice.point.model, records[r], choice.point.starts[r]);
}

class EchoFit {
 public:
  EchoFit(const std::vector<Record>& records, const Choice& choice, EchoKind kind, const Base& base)
      : records_(records), base_(base), kind_(kind) {
    double whole_s = 0;
    for (const Record& record : records) whole_s += record.length_s();
    const double block_s = std::min(longest_block_s, whole_s / folds);
    per_block_ = std::max<std::size_t>(1, static_cast<std::size_t>(block_s / base.bin_s));
    for (std::size_t r = 0; r < records.size(); ++r) add(r, started_prediction(choice, records, r));
  }

  /// Held-out residuals of the best ridge, by row; and the weights of all rows with it.
  void run() {
    double best = std::numeric_limits<double>::infinity();
    std::vector<Eigen::MatrixXd> gram(folds);
    std::vector<Eigen::VectorXd> moment(folds);
    const Eigen::Index n = columns_.cols();
    for (std::size_t f = 0; f < folds; ++f) {
      const Eigen::MatrixXd part = rows_of_fold(f);
      gram[f] = Eigen::MatrixXd::Zero(n, n);
      moment[f] = Eigen::VectorXd::Zero(n);
      if (part.rows() == 0) continue;
      gram[f].selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
      moment[f] = part.transpose() * target_of_fold(f);
    }
    for (const double ridge : ridges) {
      Eigen::VectorXd left(target_.size());
      for (std::size_t f = 0; f < folds; ++f) {
        Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
        for (std::size_t g = 0; g < folds; ++g) {
          if (g == f) continue;
          rest += gram[g];
          right += moment[g];
        }
        const Eigen::VectorXd w = solved(rest, right, ridge);
        for (Eigen::Index i = 0; i < target_.size(); ++i) {
          if (fold_[static_cast<std::size_t>(i)] == f) left(i) = target_(i) - columns_.row(i).dot(w);
        }
      }
      const double rms_mm = std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
      if (rms_mm >= best) continue;
      best = rms_mm;
      left_ = left;
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
      Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
      for (std::size_t g = 0; g < folds; ++g) {
        all += gram[g];
        right += moment[g];
      }
      weights_ = solved(all, right, ridge);
    }
    left_mm_ = best;
  }

  [[nodiscard]] double left_mm() const { return left_mm_; }

  void write(Base& base) const {
    base.kind = kind_;
    base.echo_weights = weights_.head(echo_count_);
    base.left_mm = left_mm_;
    base.left.clear();
    for (const Record& record : records_)
      base.left.emplace_back(binned(record, record.reading_mm, base.bin_s).size(),
                             std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < fold_.size(); ++i)
      base.left[record_[i]][bin_[i]] = left_(static_cast<Eigen::Index>(i));
  }

 private:
  void add(std::size_t r, const std::vector<double>& prediction) {
    const Record& record = records_[r];
    const Eigen::MatrixXd echo = echo_columns(record, record.drive_kpa, kind_, base_.largest_kpa);
    echo_count_ = echo.cols();
    std::vector<std::vector<double>> series;
    for (Eigen::Index c = 0; c < echo.cols(); ++c)
      series.push_back(binned(record, {echo.col(c).begin(), echo.col(c).end()}, base_.bin_s));
    const std::vector<double> left = binned(record, residual(record, prediction), base_.bin_s);
    std::vector<std::size_t> usable;
    for (std::size_t b = 0; b < left.size(); ++b) {
      if (std::isfinite(left[b])) usable.push_back(b);
    }
    const Eigen::Index first = columns_.rows();
    const auto own = static_cast<Eigen::Index>(series.size());
    // An offset of each record's own stands behind the columns.
    const auto width = own + static_cast<Eigen::Index>(records_.size());
    columns_.conservativeResize(first + static_cast<Eigen::Index>(usable.size()), width);
    target_.conservativeResize(columns_.rows());
    for (std::size_t i = 0; i < usable.size(); ++i) {
      const Eigen::Index row = first + static_cast<Eigen::Index>(i);
      columns_.row(row).setZero();
      for (Eigen::Index c = 0; c < own; ++c) {
        const double v = series[static_cast<std::size_t>(c)][usable[i]];
        columns_(row, c) = std::isfinite(v) ? v : 0;
      }
      columns_(row, own + static_cast<Eigen::Index>(r)) = base_.largest_kpa;
      target_(row) = left[usable[i]];
      fold_.push_back((first_block_ + usable[i] / per_block_) % folds);
      record_.push_back(r);
      bin_.push_back(usable[i]);
    }
    first_block_ += left.size() / per_block_ + 1;
  }

  [[nodiscard]] Eigen::MatrixXd rows_of_fold(std::size_t f) const {
    Eigen::MatrixXd part(std::count(fold_.begin(), fold_.end(), f), columns_.cols());
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < fold_.size(); ++i) {
      if (fold_[i] == f) part.row(at++) = columns_.row(static_cast<Eigen::Index>(i));
    }
    return part;
  }
  [[nodiscard]] Eigen::VectorXd target_of_fold(std::size_t f) const {
    Eigen::VectorXd part(std::count(fold_.begin(), fold_.end(), f));
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < fold_.size(); ++i) {
      if (fold_[i] == f) part(at++) = target_(static_cast<Eigen::Index>(i));
    }
    return part;
  }
  [[nodiscard]] Eigen::VectorXd solved(Eigen::MatrixXd gram, const Eigen::VectorXd& right,
                                       double ridge) const {
    gram.diagonal().array() +=
        ridge * static_cast<double>(target_.size()) * base_.largest_kpa * base_.largest_kpa;
    return gram.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  }

  const std::vector<Record>& records_;
  const Base& base_;
  EchoKind kind_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd target_, weights_, left_;
  std::vector<std::size_t> fold_, record_, bin_;
  std::size_t per_block_ = 1;    ///< bins
  std::size_t first_block_ = 0;  ///< of the record that is added next
  Eigen::Index echo_count_ = 0;
  double left_mm_ = 0;
};

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

/// The model's prediction with the blocks of an extension, walked anew only where they reach into it.
std::vector<double> extended_prediction(const Base& base, const Driven& driven,
                                        const std::vector<model::BlockSpec>& blocks) {
  if (blocks.empty()) return driven.plain;
  if (is_downstream(blocks, base.model, driven.record))
    return downstream(blocks, driven.record, driven.plain);
  model::Model model = base.model;
  for (const model::BlockSpec& block : blocks) model = model::with_block(std::move(model), block);
  return plain_prediction(model, driven.record);
}

std::vector<double> driven_prediction(const Base& base, const Driven& driven, const Extension& extension) {
  const Record& record = driven.record;
  std::vector<double> y = extended_prediction(base, driven, extension.chain);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double warmer = record.temperature_c.empty() ? 0 : record.temperature_c[i] - base.temperature_c;
    y[i] = (y[i] + driven.echo(static_cast<Eigen::Index>(i))) * extension.gain *
           (1 + (base.gain_per_c + extension.gain_per_c) * warmer);
  }
  if (extension.softening.share != 0) {
    const std::vector<double> factor = softened(extension.softening, record, base.largest_kpa);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= factor[i];
  }
  if (base.judged == Judged::pressure)
    y = pressure_behind(extension.line, extension.loss, record, std::move(y));
  return y;
}

}  // namespace

Driven driven_by(const Base& base, const Record& record) {
  Driven driven{base.regulator ? behind(*base.regulator, record) : record, {}, {}};
  driven.echo =
      weighted_echo(driven.record, driven.record.drive_kpa, base.kind, base.largest_kpa, base.echo_weights);
  driven.plain = plain_prediction(base.model, driven.record);
  return driven;
}

std::vector<double> predict_base(const Base& base, const Record& record, const Extension& extension,
                                 const Driven* driven) {
  if (extension.valve.empty())
    return driven_prediction(base, driven != nullptr ? *driven : driven_by(base, record), extension);
  Record after = record;
  after.drive_kpa = drive_behind(extension.valve, record);
  after.held = false;
  return driven_prediction(base, driven_by(base, after), extension);
}

Record thinned_for(const Base& base, const Record& record) {
  constexpr double finger_parts = 2, valve_parts = 4;
  return thinned_to_centres(record,
                            base.bin_s / (base.judged == Judged::pressure ? valve_parts : finger_parts));
}

std::vector<std::vector<double>> residuals_of(const Base& base, const std::vector<Record>& records) {
  std::vector<std::vector<double>> left;
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
  for (const Choice& choice : choices(records, base, options)) {
    const std::vector<Record> driven = behind(choice.regulator, records);
    for (const EchoKind kind : kinds_for(judged, drive)) {
      EchoFit echo(driven, choice, kind, base);
      echo.run();
      if (!(echo.left_mm() < base.left_mm)) continue;
      base.model = choice.point.model;
      base.regulator = choice.regulator;
      base.description = choice.description;
      echo.write(base);
    }
    if (options.progress) options.progress(choice.description);
  }
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
