#include "sysid/changes/later_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <Eigen/Cholesky>

#include "base/statistics.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/fitting/start_estimate.h"

namespace softgrip::sysid {
namespace {

/// Time constants [s] of the transient at the start of a record that begins differently from all healthy
/// records.
constexpr auto transient_lags_s = std::span(finger_lags_s).last<slow_lags>();

bool begins_as_a_healthy_one(const Base& base, const Record& record) {
  return base.judged == Judged::pressure ||
         std::any_of(base.records.begin(), base.records.end(),
                     [&](const Record& healthy) { return healthy.start_unknown == record.start_unknown; });
}

std::vector<double> transient(std::size_t bins, double bin_s, double lag_s) {
  std::vector<double> series(bins);
  for (std::size_t b = 0; b < bins; ++b) series[b] = std::exp(-middle_s(b, bin_s) / lag_s);
  return series;
}

Binned peak_rates_of(const std::vector<Record>& records, double bin_s, const Binned& left) {
  Binned all;
  for (std::size_t r = 0; r < records.size(); ++r)
    all.push_back(with_bins(peak_rate_of(records[r], bin_s), left[r].size()));
  return all;
}

}  // namespace

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
  motion_.resize(target_.size(), static_cast<Eigen::Index>(later_.size()));
  for (std::size_t r = 0; r < later_.size(); ++r) {
    Binned own = none;
    own[r] = plain_[r];
    motion_.col(static_cast<Eigen::Index>(r)) = rows_(own);
  }
  motion_left_ = motion_ - nuisance_ * (solver_ * motion_);
  motion_squares_ = motion_left_.transpose() * motion_;
}

template <class Keep>
LaterReadings LaterReadings::part(Keep keep) const {
  std::vector<Record> later;
  Binned left, plain;
  std::vector<Driven> driven;
  for (std::size_t r = 0; r < later_.size(); ++r) {
    std::vector<double> kept = left_[r];
    for (std::size_t b = 0; b < kept.size(); ++b) {
      if (!keep(r, middle_s(b, base_.bin_s))) kept[b] = std::numeric_limits<double>::quiet_NaN();
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

LaterReadings LaterReadings::without_record(std::size_t record) const {
  return part([&](std::size_t r, double) { return r != record; });
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

/// Minimises the residual by coordinate descent. The common zero offset couples the records only weakly.
Eigen::VectorXd LaterReadings::gains_of(const Eigen::VectorXd& left) const {
  constexpr int passes = 10;
  const double bound = base_.free_gain;
  const Eigen::VectorXd products = motion_left_.transpose() * left;
  Eigen::VectorXd gains = Eigen::VectorXd::Zero(products.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (Eigen::Index r = 0; r < gains.size(); ++r) {
      const double square = motion_squares_(r, r);
      if (!(square > 0)) continue;
      const double others = motion_squares_.row(r).dot(gains) - square * gains(r);
      gains(r) = std::clamp((products(r) - others) / square, -bound, bound);
    }
  }
  return gains;
}

LaterReadings::Split LaterReadings::split(const std::vector<FittedEffect>& effects) const {
  Split split;
  split.left = effects.empty() ? target_ : Eigen::VectorXd(target_ - rows_(added(effects)));
  split.gains = gains_of(split.left);
  split.left -= motion_ * split.gains;
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
  Eigen::VectorXd out(split.left.size() + split.zeros.size() + split.gains.size());
  out << white_of(split), split.gains / base_.gain_spread;
  return out;
}

LaterReadings::Nuisance LaterReadings::nuisance(const std::vector<FittedEffect>& effects) const {
  const Split split = this->split(effects);
  const double squares = motion_squares_.trace();
  return {split.zeros(0), squares > 0 ? motion_squares_.diagonal().dot(split.gains) / squares : 0};
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
  const double bound = base_.free_gain;
  double squares = 0, count = 0;
  for (std::size_t r = 0; r < left_.size(); ++r) {
    std::vector<double> error = left_[r];
    for (std::size_t b = 0; b < error.size(); ++b) error[b] -= added[r][b];
    error = without_transient(r, error);
    const std::vector<double> motion = without_transient(r, plain_[r]);
    PairSums own;
    for (std::size_t b = 0; b < error.size(); ++b) own.add(motion[b], error[b]);
    if (own.count == 0) continue;
    const double product = own.covariance() / own.count, motion_square = own.variance_x() / own.count;
    const double gain = motion_square > 0 ? std::clamp(product / motion_square, -bound, bound) : 0;
    squares += own.yy - own.y * own.y / own.count - 2 * gain * product + gain * gain * motion_square;
    count += own.count;
  }
  return count > 0 ? std::sqrt(std::max(squares, 0.0) / count) : 0;
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

std::vector<Base> left_out_bases(const Base& base) {
  std::vector<Base> bases;
  bases.reserve(base.left_out.size());
  for (const LeftOutModel& model : base.left_out) {
    bases.push_back(base);
    bases.back().model = model.model;
    bases.back().filter_weights = model.filter_weights;
  }
  return bases;
}

std::vector<LaterReadings> left_out_readings(const std::vector<Base>& bases, const std::vector<Record>& later,
                                             const std::vector<std::vector<double>>& left) {
  std::vector<LaterReadings> all;
  for (const Base& base : bases) {
    std::vector<std::vector<double>> own = residuals_of(base, later);
    for (std::size_t r = 0; r < own.size(); ++r) {
      for (std::size_t i = 0; i < own[r].size(); ++i) {
        if (std::isnan(left[r][i])) own[r][i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
    all.push_back(readings_of(base, later, own));
  }
  return all;
}

}  // namespace softgrip::sysid
