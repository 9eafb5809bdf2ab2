#include "sysid/diagnosis/evidence/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/parallel.h"
#include "sysid/diagnosis/evidence/boosting.h"
#include "sysid/diagnosis/evidence/features.h"

namespace softgrip::sysid {
namespace {

using Rows = std::vector<std::size_t>;

/// Penalties in units of the number of samples; the last one stands for no regression at all.
constexpr std::array<double, 6> penalties{1e-6, 1e-4, 1e-2, 1, 100, 1e12};
/// Below this share of the noise's variance there is nothing to explain.
constexpr double worth = 0.01;

double square(double x) {
  return x * x;
}

Eigen::MatrixXd standardised(const std::vector<std::vector<double>>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.front().size());
  Eigen::MatrixXd x(n, static_cast<Eigen::Index>(columns.size()) + 1);
  x.col(0).setOnes();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(columns[c].data(), n);
    v.array() -= v.mean();
    const double deviation = std::sqrt(v.squaredNorm() / static_cast<double>(n));
    x.col(static_cast<Eigen::Index>(c) + 1) = deviation > 0 ? Eigen::VectorXd(v / deviation) : v;
  }
  return x;
}

class Regression {
 public:
  Regression(const std::vector<Record>& records, const std::vector<std::vector<double>>& prediction_mm,
             const std::vector<std::vector<double>>& residual_mm, const ReferenceOptions& options)
      : options_(options),
        samples_(pooled_samples(records, residual_mm, options.most_samples)),
        target_(pooled(samples_, residual_mm)),
        features_(features_of(records, prediction_mm, samples_)),
        binned_(features_.columns),
        x_(standardised(features_.columns)) {
    assign_blocks(records);
  }

  Reference run(double noise_mm) {
    Reference result;
    const BlockLosses before = losses(std::vector<double>(target_.size(), 0.0));
    const double mean_square = mean(before);
    result.rmse_before_mm = std::sqrt(mean_square);
    const double structural = mean_square - square(noise_mm);
    result.present = structural > worth * square(noise_mm);
    if (!result.present) return result;
    result.structural_mm = std::sqrt(structural);
    fit_ridge();
    fit_trees();
    const std::vector<double> predicted = predictions(x_, binned_);
    const BlockLosses after = losses(predicted);
    result.rmse_after_mm = std::sqrt(mean(after));
    const Spread gain = mean_difference(before, after, options_.seed);
    const auto percent = [&](double value) { return std::clamp(100 * value / structural, 0.0, 100.0); };
    result.explained_percent = {percent(gain.value), 100 * gain.standard_error / structural,
                                percent(gain.lower), percent(gain.upper)};
    result.linear_percent = percent(mean_square - mean(losses(linear_)));
    if (result.explained_percent.value > 0) add_importance(result, mean(after), structural);
    return result;
  }

 private:
  void assign_blocks(const std::vector<Record>& records) {
    division_ = divide(records, options_.block_s);
    folds_ = std::min(options_.folds, division_.blocks.size());
    block_.assign(target_.size(), 0);
    near_.assign(folds_, std::vector<bool>(target_.size(), false));
    for (std::size_t b = 0; b < division_.blocks.size(); ++b) {
      const Block& block = division_.blocks[b];
      const Record& record = records[block.record];
      const double from = record.time_s[block.first], to = record.time_s[block.last - 1];
      for (std::size_t s = 0; s < target_.size(); ++s) {
        if (samples_.record[s] != block.record) continue;
        const double t = record.time_s[samples_.index[s]];
        if (samples_.index[s] >= block.first && samples_.index[s] < block.last) block_[s] = b;
        if (t >= from - division_.gap_s && t <= to + division_.gap_s) near_[b % folds_][s] = true;
      }
    }
    held_out_.resize(folds_);
    kept_.resize(folds_);
    for (std::size_t s = 0; s < target_.size(); ++s) {
      held_out_[block_[s] % folds_].push_back(s);
      for (std::size_t f = 0; f < folds_; ++f) {
        if (!near_[f][s]) kept_[f].push_back(s);
      }
    }
  }

  /// Mean square error by block.
  [[nodiscard]] BlockLosses losses(const std::vector<double>& predicted) const {
    BlockLosses sum(division_.blocks.size(), 0.0);
    std::vector<double> count(sum.size(), 0.0);
    for (std::size_t s = 0; s < target_.size(); ++s) {
      sum[block_[s]] += square(target_[s] - predicted[s]);
      count[block_[s]] += 1;
    }
    BlockLosses result;
    for (std::size_t b = 0; b < sum.size(); ++b) {
      if (count[b] > 0) result.push_back(sum[b] / count[b]);
    }
    return result;
  }
  [[nodiscard]] static double mean(const BlockLosses& losses) { return square(rmse_mm(losses)); }

  /// The choice whose loss is smallest over all folds but one.
  [[nodiscard]] static std::size_t best_elsewhere(const std::vector<std::vector<double>>& by_fold,
                                                  std::size_t fold) {
    std::vector<double> total(by_fold.front().size(), 0.0);
    for (std::size_t f = 0; f < by_fold.size(); ++f) {
      if (f == fold) continue;
      for (std::size_t c = 0; c < total.size(); ++c) total[c] += by_fold[f][c];
    }
    return static_cast<std::size_t>(std::min_element(total.begin(), total.end()) - total.begin());
  }

  void fit_ridge() {
    std::vector<std::vector<double>> loss(folds_, std::vector<double>(penalties.size(), 0.0));
    std::vector<std::vector<Eigen::VectorXd>> fits(folds_);
    parallel_for(folds_, options_.threads, [&](std::size_t f) {
      Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(x_.cols(), x_.cols());
      Eigen::VectorXd moment = Eigen::VectorXd::Zero(x_.cols());
      for (const std::size_t s : kept_[f]) {
        const auto row = x_.row(static_cast<Eigen::Index>(s));
        normal.selfadjointView<Eigen::Lower>().rankUpdate(row.transpose());
        moment += target_[s] * row.transpose();
      }
      for (std::size_t c = 0; c < penalties.size(); ++c) {
        Eigen::MatrixXd penalised = normal.selfadjointView<Eigen::Lower>();
        penalised.diagonal().array() += penalties[c] * static_cast<double>(kept_[f].size());
        fits[f].push_back(penalised.ldlt().solve(moment));
        for (const std::size_t s : held_out_[f])
          loss[f][c] += square(target_[s] - x_.row(static_cast<Eigen::Index>(s)).dot(fits[f][c]));
      }
    });
    for (std::size_t f = 0; f < folds_; ++f) ridge_.push_back(fits[f][best_elsewhere(loss, f)]);
    linear_ = linear(x_);
  }

  /// What the regressions say of samples that they did not see.
  [[nodiscard]] std::vector<double> linear(const Eigen::MatrixXd& x) const {
    std::vector<double> predicted(target_.size(), 0.0);
    for (std::size_t f = 0; f < folds_; ++f) {
      for (const std::size_t s : held_out_[f])
        predicted[s] = x.row(static_cast<Eigen::Index>(s)).dot(ridge_[f]);
    }
    return predicted;
  }

  void fit_trees() {
    trees_.resize(folds_);
    const BoostedTrees::Options boosting;
    std::vector<std::vector<double>> loss(folds_, std::vector<double>(boosting.rounds + 1, 0.0));
    parallel_for(folds_, options_.threads, [&](std::size_t f) {
      std::vector<double> left(target_.size());
      for (std::size_t s = 0; s < left.size(); ++s)
        left[s] = target_[s] - x_.row(static_cast<Eigen::Index>(s)).dot(ridge_[f]);
      std::vector<double> judged = left;
      const auto judge = [&](std::size_t round) {
        for (const std::size_t s : held_out_[f]) {
          if (round > 0) judged[s] -= trees_[f].predict_last(binned_, s);
          loss[f][round] += square(judged[s]);
        }
      };
      judge(0);
      trees_[f].fit(binned_, left, kept_[f], boosting, judge);
    });
    for (std::size_t f = 0; f < folds_; ++f) rounds_.push_back(best_elsewhere(loss, f));
  }

  [[nodiscard]] std::vector<double> predictions(const Eigen::MatrixXd& x,
                                                const BinnedFeatures& binned) const {
    std::vector<double> predicted = linear(x);
    for (std::size_t f = 0; f < folds_; ++f) {
      for (const std::size_t s : held_out_[f]) predicted[s] += trees_[f].predict(binned, s, rounds_[f]);
    }
    return predicted;
  }

  void add_importance(Reference& result, double after, double structural) const {
    Rows from(target_.size());
    std::iota(from.begin(), from.end(), std::size_t{0});
    std::mt19937_64 random(options_.seed);
    std::shuffle(from.begin(), from.end(), random);
    for (const Features::Group& group : features_.groups) {
      Eigen::MatrixXd x = x_;
      BinnedFeatures binned = binned_;
      for (const std::size_t c : group.columns) {
        binned.permute(c, from);
        const auto column = static_cast<Eigen::Index>(c) + 1;
        for (std::size_t s = 0; s < from.size(); ++s)
          x(static_cast<Eigen::Index>(s), column) = x_(static_cast<Eigen::Index>(from[s]), column);
      }
      const double lost = mean(losses(predictions(x, binned))) - after;
      result.groups.push_back({group.id, group.phrase, std::max(0.0, 100 * lost / structural)});
    }
    std::stable_sort(result.groups.begin(), result.groups.end(), [](const auto& a, const auto& b) {
      return a.importance_percent > b.importance_percent;
    });
  }

  const ReferenceOptions& options_;
  Samples samples_;
  std::vector<double> target_;
  Features features_;
  BinnedFeatures binned_;
  Eigen::MatrixXd x_;  ///< first column: ones
  Division division_;
  std::size_t folds_ = 0;
  std::vector<std::size_t> block_;
  std::vector<std::vector<bool>> near_;  ///< by fold: in a held-out block or within the gap of one
  std::vector<Rows> held_out_;
  std::vector<Rows> kept_;
  std::vector<Eigen::VectorXd> ridge_;
  std::vector<double> linear_;
  std::vector<BoostedTrees> trees_;
  std::vector<std::size_t> rounds_;
};

}  // namespace

Reference smooth_reference(const std::vector<Record>& records,
                           const std::vector<std::vector<double>>& prediction_mm,
                           const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                           const ReferenceOptions& options) {
  Regression regression(records, prediction_mm, residual_mm, options);
  return regression.run(noise_mm);
}

}  // namespace softgrip::sysid
