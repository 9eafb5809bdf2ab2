#include "sysid/changes/echo_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace softgrip::sysid {
namespace {

constexpr std::array ridges{1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
/// Held out in turn, in blocks, fewer seconds where there are few. Shorter than what a finger remembers, a
/// block is known from its neighbours, and a slow echo that has merely learnt the order of the healthy logs
/// by heart passes: on the next day it is a zero that wanders.
constexpr double longest_block_s = 10;
constexpr std::size_t folds = 8;

using Factor = Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower>;

/// The columns of all records in bins, each row in its fold.
class EchoBank {
 public:
  EchoBank(const std::vector<Record>& records, EchoKind kind, double bin_s, double largest_kpa,
           const Binned& readings)
      : kind_(kind), bin_s_(bin_s), largest_kpa_(largest_kpa) {
    double whole_s = 0;
    for (const Record& record : records) whole_s += record.length_s();
    const double block_s = std::min(longest_block_s, whole_s / folds);
    per_block_ = std::max<std::size_t>(1, static_cast<std::size_t>(block_s / bin_s));
    for (std::size_t r = 0; r < records.size(); ++r) add(records, r, readings[r]);
    for (std::size_t f = 0; f < folds; ++f) {
      const Eigen::MatrixXd part = columns_of(f);
      gram_.push_back(Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols()));
      if (part.rows() > 0) gram_[f].selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    }
  }

  /// A model's target, and what is known of its fit.
  struct Target {
    Eigen::VectorXd values;
    std::vector<Eigen::VectorXd> moment;  ///< by fold
    Eigen::VectorXd weights, left;
    double left_mm = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] Target target_of(const Binned& readings) const {
    Target target;
    target.values.resize(columns_.rows());
    for (std::size_t i = 0; i < fold_.size(); ++i)
      target.values(static_cast<Eigen::Index>(i)) = readings[record_[i]][bin_[i]];
    for (std::size_t f = 0; f < folds; ++f) {
      const Eigen::MatrixXd part = columns_of(f);
      target.moment.push_back(Eigen::VectorXd::Zero(columns_.cols()));
      if (part.rows() > 0) target.moment[f] = part.transpose() * values_of(target.values, f);
    }
    return target;
  }

  /// Every target with the ridge that leaves least of it.
  void fit(std::vector<Target>& targets) const {
    for (const double ridge : ridges) {
      std::vector<Eigen::VectorXd> left(targets.size(), Eigen::VectorXd(columns_.rows()));
      for (std::size_t f = 0; f < folds; ++f) {
        const Factor factor = factor_without(f, ridge);
        for (std::size_t t = 0; t < targets.size(); ++t) {
          const Eigen::VectorXd w = factor.solve(moment_without(targets[t], f));
          for (Eigen::Index i = 0; i < left[t].size(); ++i) {
            if (fold_[static_cast<std::size_t>(i)] == f)
              left[t](i) = targets[t].values(i) - columns_.row(i).dot(w);
          }
        }
      }
      const Factor whole = factor_without(folds, ridge);
      for (std::size_t t = 0; t < targets.size(); ++t) {
        const double rms_mm = std::sqrt(left[t].squaredNorm() / static_cast<double>(left[t].size()));
        if (rms_mm >= targets[t].left_mm) continue;
        targets[t].left_mm = rms_mm;
        targets[t].left = left[t];
        targets[t].weights = whole.solve(moment_without(targets[t], folds));
      }
    }
  }

  /// @param left  by model: as it was, now with what the echo leaves where there is a reading.
  [[nodiscard]] FittedEcho answer(const Target& target, Binned left) const {
    for (std::vector<double>& series : left)
      std::fill(series.begin(), series.end(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < fold_.size(); ++i)
      left[record_[i]][bin_[i]] = target.left(static_cast<Eigen::Index>(i));
    return {target.weights.head(echo_count_), std::move(left), target.left_mm};
  }

 private:
  void add(const std::vector<Record>& records, std::size_t r, const std::vector<double>& readings) {
    const Record& record = records[r];
    const Eigen::MatrixXd echo = echo_columns(record, record.drive_kpa, kind_, largest_kpa_);
    echo_count_ = echo.cols();
    std::vector<std::size_t> usable;
    for (std::size_t b = 0; b < readings.size(); ++b) {
      if (std::isfinite(readings[b])) usable.push_back(b);
    }
    const Eigen::Index first = columns_.rows();
    // An offset of each record's own stands behind the columns.
    const auto width = echo_count_ + static_cast<Eigen::Index>(records.size());
    columns_.conservativeResize(first + static_cast<Eigen::Index>(usable.size()), width);
    columns_.bottomRows(static_cast<Eigen::Index>(usable.size())).setZero();
    for (Eigen::Index c = 0; c < echo_count_; ++c) {
      const std::vector<double> series = binned(record, {echo.col(c).begin(), echo.col(c).end()}, bin_s_);
      for (std::size_t i = 0; i < usable.size(); ++i) {
        const double v = series[usable[i]];
        columns_(first + static_cast<Eigen::Index>(i), c) = std::isfinite(v) ? v : 0;
      }
    }
    for (std::size_t i = 0; i < usable.size(); ++i) {
      columns_(first + static_cast<Eigen::Index>(i), echo_count_ + static_cast<Eigen::Index>(r)) =
          largest_kpa_;
      fold_.push_back((first_block_ + usable[i] / per_block_) % folds);
      record_.push_back(r);
      bin_.push_back(usable[i]);
    }
    first_block_ += readings.size() / per_block_ + 1;
  }

  [[nodiscard]] Eigen::MatrixXd columns_of(std::size_t f) const {
    Eigen::MatrixXd part(std::count(fold_.begin(), fold_.end(), f), columns_.cols());
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < fold_.size(); ++i) {
      if (fold_[i] == f) part.row(at++) = columns_.row(static_cast<Eigen::Index>(i));
    }
    return part;
  }
  [[nodiscard]] Eigen::VectorXd values_of(const Eigen::VectorXd& values, std::size_t f) const {
    Eigen::VectorXd part(std::count(fold_.begin(), fold_.end(), f));
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < fold_.size(); ++i) {
      if (fold_[i] == f) part(at++) = values(static_cast<Eigen::Index>(i));
    }
    return part;
  }

  /// Of all folds but one; without one: folds.
  [[nodiscard]] Factor factor_without(std::size_t f, double ridge) const {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
    for (std::size_t g = 0; g < folds; ++g) {
      if (g != f) gram += gram_[g];
    }
    gram.diagonal().array() += ridge * static_cast<double>(columns_.rows()) * largest_kpa_ * largest_kpa_;
    return gram.selfadjointView<Eigen::Lower>().ldlt();
  }
  [[nodiscard]] Eigen::VectorXd moment_without(const Target& target, std::size_t f) const {
    Eigen::VectorXd moment = Eigen::VectorXd::Zero(columns_.cols());
    for (std::size_t g = 0; g < folds; ++g) {
      if (g != f) moment += target.moment[g];
    }
    return moment;
  }

  EchoKind kind_;
  double bin_s_, largest_kpa_;
  Eigen::MatrixXd columns_;
  std::vector<Eigen::MatrixXd> gram_;             ///< by fold
  std::vector<std::size_t> fold_, record_, bin_;  ///< of each row
  std::size_t per_block_ = 1;                     ///< bins
  std::size_t first_block_ = 0;                   ///< of the record that is added next
  Eigen::Index echo_count_ = 0;
};

bool same_bins(const Binned& x, const Binned& y) {
  return std::ranges::equal(x, y, [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b, [](double u, double v) { return std::isfinite(u) == std::isfinite(v); });
  });
}

}  // namespace

std::vector<FittedEcho> fit_echo(const std::vector<Record>& records, EchoKind kind, double bin_s,
                                 double largest_kpa, const std::vector<Binned>& left) {
  const EchoBank bank(records, kind, bin_s, largest_kpa, left.front());
  std::vector<EchoBank::Target> targets;
  for (const Binned& model : left) {
    if (same_bins(model, left.front())) targets.push_back(bank.target_of(model));
  }
  bank.fit(targets);
  std::vector<FittedEcho> fits;
  fits.reserve(left.size());
  auto target = targets.begin();
  for (const Binned& model : left) {
    // A model whose answer is not finite everywhere has rows of its own.
    fits.push_back(same_bins(model, left.front()) ? bank.answer(*target++, model)
                                                  : fit_echo(records, kind, bin_s, largest_kpa, {model})[0]);
  }
  return fits;
}

}  // namespace softgrip::sysid
