#include "sysid/changes/effect_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Cholesky>

#include "base/statistics.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/fitting/descent.h"
#include "sysid/fitting/start_estimate.h"

namespace softgrip::sysid {
namespace {

constexpr int most_effect_steps = 9;
constexpr std::size_t followed = 2;
/// Smallest damping of a parameter, as a share of the sum of all curvatures.
constexpr double least_curvature = 0.01;
/// sized() is not applied to an effect with more start points than this number, because its start points are
/// close together.
constexpr std::size_t most_sized = 16;

/// Time constants [s] of the transient in a record that begins differently from all healthy records.
constexpr auto transient_lags_s = std::span(finger_lags_s).last<slow_lags>();

bool begins_as_a_healthy_one(const Base& base, const Record& record) {
  return base.judged == Judged::pressure ||
         std::any_of(base.records.begin(), base.records.end(),
                     [&](const Record& healthy) { return healthy.start_unknown == record.start_unknown; });
}

std::vector<double> transient(std::size_t bins, double bin_s, double lag_s) {
  std::vector<double> series(bins);
  for (std::size_t b = 0; b < bins; ++b)
    series[b] = std::exp(-(static_cast<double>(b) + 0.5) * bin_s / lag_s);
  return series;
}

/// Returns the largest relative gain that does not count as a change. Another run of an unchanged finger may
/// have this gain.
double free_gain(const Base& base) {
  return t_quantile(static_cast<double>(base.units.count() - 1)) * base.gain_spread;
}

std::vector<double> within(const Effect& effect, std::vector<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = std::clamp(numbers[i], effect.numbers[i].lower, effect.numbers[i].upper);
  return numbers;
}

/// Returns the unit of a parameter during the fit.
double unit(const FittedEffect& fitted, std::size_t i) {
  const double scale = std::min(fitted.effect.numbers[i].scale, fitted.effect.numbers[i].upper);
  return std::max(0.3 * std::abs(fitted.numbers[i]), 0.05 * scale);
}

class Fit {
 public:
  Fit(const LaterReadings& readings, const Effect& effect, const std::vector<FittedEffect>& others)
      : readings_(readings), effect_(effect), others_(others) {}

  [[nodiscard]] EffectFit at(const std::vector<double>& numbers) const {
    std::vector<FittedEffect> all = others_;
    all.push_back({effect_, numbers});
    EffectFit fit{{effect_, numbers}, 0, readings_.white(all)};
    fit.sum_of_squares = fit.white.squaredNorm();
    if (!std::isfinite(fit.sum_of_squares)) fit.sum_of_squares = std::numeric_limits<double>::infinity();
    return fit;
  }

  /// Returns the better one of two fits: the start point, and the start point scaled to the size of the
  /// effect that fits best.
  [[nodiscard]] EffectFit sized(EffectFit fit, const Eigen::VectorXd& without) const {
    if (!std::isfinite(fit.sum_of_squares)) return fit;
    const Eigen::VectorXd change = fit.white - without;
    const double square = change.squaredNorm();
    const double share = square > 0 ? -change.dot(without) / square : 0;
    if (share <= 0.02 || share >= 0.98) return fit;
    std::vector<double> smaller = fit.fitted.numbers;
    for (std::size_t i = 0; i < smaller.size(); ++i) {
      const double nothing = limit_of_nothing(i);
      if (std::isfinite(nothing)) smaller[i] = nothing + share * (smaller[i] - nothing);
    }
    EffectFit other = at(within(effect_, smaller));
    return other.sum_of_squares < fit.sum_of_squares ? other : fit;
  }

  [[nodiscard]] EffectFit descended(EffectFit from) const {
    return descend(*this, std::move(from),
                   {.most_steps = most_effect_steps,
                    .most_trials = 5,
                    .longest_step = std::numeric_limits<double>::infinity(),
                    .least_share = 1e-4,
                    .least_gain = 0.1,
                    // If the fitted common gain can replace the gain of an effect, the gain of the effect has
                    // no curvature.
                    .least_damping = least_curvature})
        .point;
  }

  [[nodiscard]] static double loss(const EffectFit& fit) { return fit.sum_of_squares; }

  [[nodiscard]] NormalEquations normal(const EffectFit& from) const {
    const auto n = static_cast<Eigen::Index>(effect_.numbers.size());
    Eigen::MatrixXd jacobian(from.white.size(), n);
    for (Eigen::Index k = 0; k < n; ++k) jacobian.col(k) = derivative(from, static_cast<std::size_t>(k));
    return {jacobian.transpose() * from.white, jacobian.transpose() * jacobian};
  }

  [[nodiscard]] StepBounds bounds(const EffectFit& from) const {
    const auto n = static_cast<Eigen::Index>(effect_.numbers.size());
    StepBounds bounds{Eigen::VectorXd(n), Eigen::VectorXd(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      bounds.lower(k) = (effect_.numbers[i].lower - from.fitted.numbers[i]) / unit(from.fitted, i);
      bounds.upper(k) = (effect_.numbers[i].upper - from.fitted.numbers[i]) / unit(from.fitted, i);
    }
    return bounds;
  }

  [[nodiscard]] EffectFit moved(const EffectFit& from, const Eigen::VectorXd& step) const {
    std::vector<double> numbers = from.fitted.numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] += step(static_cast<Eigen::Index>(i)) * unit(from.fitted, i);
    return at(within(effect_, numbers));
  }

 private:
  /// Returns the value of the parameter at which the effect vanishes. If this value is far outside the data,
  /// returns the value at which the effect begins.
  [[nodiscard]] double limit_of_nothing(std::size_t i) const {
    const double nothing = effect_.nothing[i];
    double reach = std::numeric_limits<double>::infinity();
    if (effect_.numbers[i].unit == "kPa") reach = largest(&Record::largest_kpa);
    if (effect_.numbers[i].unit == "mm") reach = largest(&Record::span_mm);
    return std::abs(nothing) > 1.5 * reach ? reach : nothing;
  }
  [[nodiscard]] double largest(double Record::*of_record) const {
    double largest = 0;
    for (const Record& record : readings_.records()) largest = std::max(largest, record.*of_record);
    return largest;
  }
  [[nodiscard]] Eigen::VectorXd derivative(const EffectFit& from, std::size_t k) const {
    std::vector<double> beside = from.fitted.numbers;
    const double by = small_move(from.fitted, k);
    beside[k] += by;
    return (at(beside).white - from.white) * (unit(from.fitted, k) / by);
  }

  const LaterReadings& readings_;
  const Effect& effect_;
  const std::vector<FittedEffect>& others_;
};

Binned peak_rates_of(const std::vector<Record>& records, double bin_s, const Binned& left) {
  Binned all;
  for (std::size_t r = 0; r < records.size(); ++r)
    all.push_back(with_bins(peak_rate_of(records[r], bin_s), left[r].size()));
  return all;
}

}  // namespace

double small_move(const FittedEffect& fitted, std::size_t number) {
  const double by = 0.02 * unit(fitted, number);
  return fitted.numbers[number] + by > fitted.effect.numbers[number].upper ? -by : by;
}

Extension extension_of(const std::vector<FittedEffect>& effects) {
  Extension extension;
  for (const FittedEffect& each : effects) each.effect.apply(extension, each.numbers);
  return extension;
}

LaterReadings::LaterReadings(const Base& base, std::vector<Record> later, Binned left)
    : LaterReadings([&] {
        std::vector<Driven> driven;
        Binned plain;
        for (std::size_t r = 0; r < later.size(); ++r) {
          driven.push_back(driven_by(base, later[r]));
          plain.push_back(
              with_bins(binned(later[r], predict_base(base, later[r], {}, &driven.back()), base.bin_s),
                        left[r].size()));
        }
        return LaterReadings(base, std::move(later), std::move(left), std::move(plain), std::move(driven));
      }()) {}

LaterReadings::LaterReadings(const Base& base, std::vector<Record> later, Binned left, Binned plain,
                             std::vector<Driven> driven)
    : base_(base),
      later_(std::move(later)),
      left_(std::move(left)),
      plain_(std::move(plain)),
      driven_(std::move(driven)),
      rows_(left_, peak_rates_of(later_, base.bin_s, left_), base.whitener) {
  target_ = rows_(left_);
  std::vector<Eigen::VectorXd> columns;
  std::vector<double> prices;
  const auto add = [&](const Binned& series, double price) {
    columns.push_back(rows_(series));
    prices.push_back(price);
  };
  Binned none = plain_;
  for (auto& series : none) std::fill(series.begin(), series.end(), 0.0);
  Binned ones = none;
  for (auto& series : ones) std::fill(series.begin(), series.end(), 1.0);
  add(ones, 0);
  for (std::size_t r = 0; r < later_.size(); ++r) {
    Binned own = none;
    own[r] = ones[r];
    add(own, 1 / base_.zero_spread_mm);
  }
  for (std::size_t r = 0; r < later_.size(); ++r) {
    if (begins_as_a_healthy_one(base_, later_[r])) continue;
    Binned own = none;
    for (const double lag_s : transient_lags_s) {
      own[r] = transient(own[r].size(), base_.bin_s, lag_s);
      add(own, 0);
    }
  }
  nuisance_.resize(target_.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) nuisance_.col(static_cast<Eigen::Index>(k)) = columns[k];
  price_ = Eigen::Map<const Eigen::VectorXd>(prices.data(), nuisance_.cols());
  Eigen::MatrixXd normal = nuisance_.transpose() * nuisance_;
  normal.diagonal() += price_.cwiseAbs2();
  normal.diagonal().array() += 1e-9;
  solver_ = normal.ldlt().solve(nuisance_.transpose());
  motion_ = rows_(plain_);
  motion_left_ = motion_ - nuisance_ * (solver_ * motion_);
}

template <class Keep>
LaterReadings LaterReadings::part(Keep keep) const {
  std::vector<Record> later;
  Binned left, plain;
  std::vector<Driven> driven;
  for (std::size_t r = 0; r < later_.size(); ++r) {
    std::vector<double> kept = left_[r];
    for (std::size_t b = 0; b < kept.size(); ++b) {
      if (!keep(r, (static_cast<double>(b) + 0.5) * base_.bin_s))
        kept[b] = std::numeric_limits<double>::quiet_NaN();
    }
    if (std::none_of(kept.begin(), kept.end(), [](double v) { return std::isfinite(v); })) continue;
    later.push_back(later_[r]);
    left.push_back(std::move(kept));
    plain.push_back(plain_[r]);
    driven.push_back(driven_[r]);
  }
  return {base_, std::move(later), std::move(left), std::move(plain), std::move(driven)};
}

LaterReadings LaterReadings::only(const Units& units, std::size_t unit) const {
  return part([&](std::size_t r, double s) { return units.unit_of(r, s) == unit; });
}

LaterReadings LaterReadings::without(const Units& units, std::size_t unit) const {
  return part([&](std::size_t r, double s) { return units.unit_of(r, s) != unit; });
}

LaterReadings healthy_readings(const Base& base) {
  return {base, base.records, base.left};
}

Binned LaterReadings::added(const std::vector<FittedEffect>& effects) const {
  const Extension extension = extension_of(effects);
  Binned added;
  for (std::size_t r = 0; r < later_.size(); ++r) {
    added.push_back(
        with_bins(binned(later_[r], predict_base(base_, later_[r], extension, &driven_[r]), base_.bin_s),
                  left_[r].size()));
    for (std::size_t b = 0; b < added[r].size(); ++b) added[r][b] -= plain_[r][b];
  }
  return added;
}

LaterReadings::Split LaterReadings::split(const std::vector<FittedEffect>& effects) const {
  Split split;
  split.left = effects.empty() ? target_ : Eigen::VectorXd(target_ - rows_(added(effects)));
  const double bound = free_gain(base_);
  const double square = motion_left_.dot(motion_);
  split.gain = square > 0 ? std::clamp(motion_left_.dot(split.left) / square, -bound, bound) : 0;
  split.left -= split.gain * motion_;
  split.zeros = solver_ * split.left;
  split.left -= nuisance_ * split.zeros;
  return split;
}

Eigen::VectorXd LaterReadings::white_of(const Split& split) const {
  Eigen::VectorXd out(split.left.size() + split.zeros.size());
  out << split.left, price_.cwiseProduct(split.zeros);
  return out;
}

Eigen::VectorXd LaterReadings::white(const std::vector<FittedEffect>& effects) const {
  return white_of(split(effects));
}

Eigen::VectorXd LaterReadings::white_and_gain(const std::vector<FittedEffect>& effects) const {
  const Split split = this->split(effects);
  Eigen::VectorXd out(split.left.size() + split.zeros.size() + 1);
  out << white_of(split), split.gain / base_.gain_spread;
  return out;
}

LaterReadings::Nuisance LaterReadings::nuisance(const std::vector<FittedEffect>& effects) const {
  const Split split = this->split(effects);
  return {split.zeros(0), split.gain};
}

std::vector<std::string> LaterReadings::other_starts() const {
  std::vector<std::string> names;
  for (const Record& record : later_) {
    if (!begins_as_a_healthy_one(base_, record)) names.push_back(record.name);
  }
  return names;
}

std::vector<double> LaterReadings::without_transient(std::size_t record,
                                                     const std::vector<double>& series) const {
  if (begins_as_a_healthy_one(base_, later_[record])) return series;
  constexpr Eigen::Index lags = transient_lags_s.size();
  const auto bins = static_cast<Eigen::Index>(series.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(bins, lags + 1);
  for (Eigen::Index l = 0; l < lags; ++l) {
    const std::vector<double> own =
        transient(series.size(), base_.bin_s, transient_lags_s[static_cast<std::size_t>(l)]);
    columns.col(l) = Eigen::Map<const Eigen::VectorXd>(own.data(), bins);
  }
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(lags + 1, lags + 1) * 1e-9;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(lags + 1);
  for (Eigen::Index b = 0; b < bins; ++b) {
    const double value = series[static_cast<std::size_t>(b)];
    if (!std::isfinite(value)) continue;
    normal += columns.row(b).transpose() * columns.row(b);
    right += columns.row(b).transpose() * value;
  }
  const Eigen::VectorXd taken = columns * normal.ldlt().solve(right);
  std::vector<double> left = series;
  for (Eigen::Index b = 0; b < bins; ++b) left[static_cast<std::size_t>(b)] -= taken(b);
  return left;
}

double LaterReadings::plain_rms(const std::vector<FittedEffect>& effects) const {
  const Binned added = this->added(effects);
  double misses = 0, products = 0, motions = 0, count = 0;
  for (std::size_t r = 0; r < left_.size(); ++r) {
    std::vector<double> error = left_[r];
    for (std::size_t b = 0; b < error.size(); ++b) error[b] -= added[r][b];
    error = without_transient(r, error);
    const std::vector<double> motion = without_transient(r, plain_[r]);
    PairSums own;
    for (std::size_t b = 0; b < error.size(); ++b) own.add(motion[b], error[b]);
    if (own.count == 0) continue;
    misses += own.yy - own.y * own.y / own.count;
    products += own.covariance() / own.count;
    motions += own.variance_x() / own.count;
    count += own.count;
  }
  const double bound = free_gain(base_);
  const double gain = motions > 0 ? std::clamp(products / motions, -bound, bound) : 0;
  const double left = misses - 2 * gain * products + gain * gain * motions;
  return count > 0 ? std::sqrt(std::max(left, 0.0) / count) : 0;
}

LaterReadings readings_of(const Base& base, const std::vector<Record>& records,
                          const std::vector<std::vector<double>>& left) {
  std::vector<Record> thinned;
  Binned left_in_bins;
  for (std::size_t r = 0; r < records.size(); ++r) {
    thinned.push_back(thinned_for(base, records[r]));
    left_in_bins.push_back(binned(records[r], left[r], base.bin_s));
    const double begin_bins = begin_s(records[r]) / base.bin_s;
    for (std::size_t b = 0; b < left_in_bins.back().size() && static_cast<double>(b) + 0.5 <= begin_bins; ++b)
      left_in_bins.back()[b] = std::numeric_limits<double>::quiet_NaN();
  }
  return {base, std::move(thinned), std::move(left_in_bins)};
}

EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                     const std::vector<FittedEffect>& others, const Eigen::VectorXd& without) {
  const Fit fit(readings, effect, others);
  const bool dense = effect.starts.size() > most_sized;
  std::vector<EffectFit> looks;
  for (const std::vector<double>& start : effect.starts) {
    EffectFit first = fit.at(within(effect, start));
    // If the prediction does not change with the effect, the result is the same for all start points.
    if (!effect.free_form && looks.empty() && first.white == without) return first;
    looks.push_back(dense ? std::move(first) : fit.sized(std::move(first), without));
  }
  std::sort(looks.begin(), looks.end(),
            [](const EffectFit& a, const EffectFit& b) { return a.sum_of_squares < b.sum_of_squares; });
  EffectFit best = fit.descended(looks.front());
  for (std::size_t i = 1; i < std::min(followed, looks.size()); ++i) {
    EffectFit other = fit.descended(looks[i]);
    if (other.sum_of_squares < best.sum_of_squares) best = std::move(other);
  }
  return best;
}

}  // namespace softgrip::sysid
