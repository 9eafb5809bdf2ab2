#include "sysid/changes/effect_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "base/statistics.h"

namespace softgrip::sysid {
namespace {

constexpr int most_steps = 9;
constexpr std::size_t followed = 2;
/// A gain is free within so many of the healthy logs' own spreads; beyond, it is a change.
constexpr double gain_bound = 2;

std::vector<double> within(const Effect& effect, std::vector<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = std::clamp(numbers[i], effect.numbers[i].lower, effect.numbers[i].upper);
  return numbers;
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

  /// A start, and what it promises if it were of the right size.
  [[nodiscard]] EffectFit sized(const std::vector<double>& start, const Eigen::VectorXd& without) const {
    EffectFit fit = at(within(effect_, start));
    if (!std::isfinite(fit.sum_of_squares)) return fit;
    const Eigen::VectorXd change = fit.white - without;
    const double square = change.squaredNorm();
    const double share = square > 0 ? -change.dot(without) / square : 0;
    if (share <= 0.02 || share >= 0.98) return fit;
    std::vector<double> smaller = start;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const double nothing = limit_of_nothing(i);
      if (std::isfinite(nothing)) smaller[i] = nothing + share * (start[i] - nothing);
    }
    EffectFit other = at(within(effect_, smaller));
    return other.sum_of_squares < fit.sum_of_squares ? other : fit;
  }

  [[nodiscard]] EffectFit descend(EffectFit best) const {
    const auto n = static_cast<Eigen::Index>(effect_.numbers.size());
    double damping = 1e-2;
    for (int step = 0; step < most_steps && n > 0; ++step) {
      Eigen::MatrixXd jacobian(best.white.size(), n);
      for (Eigen::Index k = 0; k < n; ++k) jacobian.col(k) = derivative(best, static_cast<std::size_t>(k));
      const Eigen::VectorXd gradient = jacobian.transpose() * best.white;
      Eigen::MatrixXd curvature = jacobian.transpose() * jacobian;
      bool improved = false, settled = false;
      for (int attempt = 0; attempt < 5 && !improved; ++attempt) {
        Eigen::MatrixXd damped = curvature;
        damped.diagonal() *= 1 + damping;
        damped.diagonal().array() += 1e-12 + 1e-9 * curvature.trace();
        const Eigen::VectorXd by = -damped.ldlt().solve(gradient);
        std::vector<double> moved = best.fitted.numbers;
        for (std::size_t i = 0; i < moved.size(); ++i)
          moved[i] += by(static_cast<Eigen::Index>(i)) * unit(best.fitted.numbers, i);
        EffectFit trial = at(within(effect_, moved));
        improved = trial.sum_of_squares < best.sum_of_squares;
        settled = improved && best.sum_of_squares - trial.sum_of_squares < 1e-4 * best.sum_of_squares + 0.1;
        damping = improved ? std::max(damping / 5, 1e-6) : damping * 6;
        if (improved) best = std::move(trial);
      }
      if (!improved || settled) break;
    }
    return best;
  }

 private:
  /// Where the number does nothing; of a bound far away, where it just begins to.
  [[nodiscard]] double limit_of_nothing(std::size_t i) const {
    const double nothing = effect_.nothing[i];
    const Base& base = readings_.base();
    const double reach = effect_.numbers[i].unit == "kPa"  ? base.largest_kpa
                         : effect_.numbers[i].unit == "mm" ? base.span_mm
                                                           : std::numeric_limits<double>::infinity();
    return std::abs(nothing) > 1.5 * reach ? reach : nothing;
  }
  [[nodiscard]] double unit(const std::vector<double>& numbers, std::size_t i) const {
    const double scale = std::min(effect_.numbers[i].scale, effect_.numbers[i].upper);
    return std::max(0.3 * std::abs(numbers[i]), 0.05 * scale);
  }
  [[nodiscard]] Eigen::VectorXd derivative(const EffectFit& from, std::size_t k) const {
    std::vector<double> beside = from.fitted.numbers;
    double by = 0.02 * unit(from.fitted.numbers, k);
    if (beside[k] + by > effect_.numbers[k].upper) by = -by;
    beside[k] += by;
    return (at(beside).white - from.white) * (unit(from.fitted.numbers, k) / by);
  }

  const LaterReadings& readings_;
  const Effect& effect_;
  const std::vector<FittedEffect>& others_;
};

Binned all_haste_of(const std::vector<Record>& records, double bin_s, const Binned& left) {
  Binned all;
  for (std::size_t r = 0; r < records.size(); ++r)
    all.push_back(with_bins(haste_of(records[r], bin_s), left[r].size()));
  return all;
}

}  // namespace

Extension extension_of(const std::vector<FittedEffect>& effects) {
  Extension extension;
  for (const FittedEffect& each : effects) each.effect.apply(extension, each.numbers);
  return extension;
}

LaterReadings::LaterReadings(const Base& base, std::vector<Record> later, Binned left)
    : base_(base),
      later_(std::move(later)),
      left_(std::move(left)),
      rows_(left_, all_haste_of(later_, base.bin_s, left_), base.whitener) {
  for (std::size_t r = 0; r < later_.size(); ++r) {
    driven_.push_back(driven_by(base_, later_[r]));
    plain_.push_back(
        with_bins(binned(later_[r], predict_base(base_, later_[r], {}, &driven_.back()), base_.bin_s),
                  left_[r].size()));
  }
  target_ = rows_(left_);
  const std::size_t n = later_.size();
  slack_.resize(target_.size(), static_cast<Eigen::Index>(n) + 1);
  price_ = Eigen::VectorXd::Zero(slack_.cols());
  Binned ones = plain_;
  for (auto& series : ones) std::fill(series.begin(), series.end(), 1.0);
  slack_.col(0) = rows_(ones);
  for (std::size_t r = 0; r < n; ++r) {
    Binned own = ones;
    for (std::size_t s = 0; s < n; ++s) {
      if (s != r) std::fill(own[s].begin(), own[s].end(), 0.0);
    }
    slack_.col(static_cast<Eigen::Index>(r) + 1) = rows_(own);
    price_(static_cast<Eigen::Index>(r) + 1) = 1 / base_.zero_spread_mm;
  }
  Eigen::MatrixXd normal = slack_.transpose() * slack_;
  normal.diagonal() += price_.cwiseAbs2();
  normal.diagonal().array() += 1e-9;
  solver_ = normal.ldlt().solve(slack_.transpose());
  motion_ = rows_(plain_);
  motion_left_ = motion_ - slack_ * (solver_ * motion_);
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
  const double bound = gain_bound * base_.gain_spread;
  const double square = motion_left_.dot(motion_);
  split.gain = square > 0 ? std::clamp(motion_left_.dot(split.left) / square, -bound, bound) : 0;
  split.left -= split.gain * motion_;
  split.zeros = solver_ * split.left;
  split.left -= slack_ * split.zeros;
  return split;
}

Eigen::VectorXd LaterReadings::white(const std::vector<FittedEffect>& effects) const {
  const Split split = this->split(effects);
  Eigen::VectorXd out(split.left.size() + split.zeros.size());
  out << split.left, price_.cwiseProduct(split.zeros);
  return out;
}

LaterReadings::Slack LaterReadings::slack(const std::vector<FittedEffect>& effects) const {
  const Split split = this->split(effects);
  return {split.zeros(0), split.gain};
}

double LaterReadings::plain_rms(const std::vector<FittedEffect>& effects) const {
  const Binned added = this->added(effects);
  double misses = 0, products = 0, motions = 0, count = 0;
  for (std::size_t r = 0; r < left_.size(); ++r) {
    PairSums own;
    for (std::size_t b = 0; b < left_[r].size(); ++b) own.add(plain_[r][b], left_[r][b] - added[r][b]);
    if (own.count == 0) continue;
    misses += own.yy - own.y * own.y / own.count;
    products += own.covariance() / own.count;
    motions += own.variance_x() / own.count;
    count += own.count;
  }
  const double bound = gain_bound * base_.gain_spread;
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
  }
  return {base, std::move(thinned), std::move(left_in_bins)};
}

EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                     const std::vector<FittedEffect>& others, const Eigen::VectorXd& without) {
  const Fit fit(readings, effect, others);
  std::vector<EffectFit> looks;
  for (const std::vector<double>& start : effect.starts) {
    looks.push_back(fit.sized(start, without));
    // A base that cannot show the effect at all shows it from no other start.
    if (!effect.free_form && looks.size() == 1 && looks[0].white == without) return looks[0];
  }
  std::sort(looks.begin(), looks.end(),
            [](const EffectFit& a, const EffectFit& b) { return a.sum_of_squares < b.sum_of_squares; });
  EffectFit best = fit.descend(looks.front());
  for (std::size_t i = 1; i < std::min(followed, looks.size()); ++i) {
    EffectFit other = fit.descend(looks[i]);
    if (other.sum_of_squares < best.sum_of_squares) best = std::move(other);
  }
  return best;
}

}  // namespace softgrip::sysid
