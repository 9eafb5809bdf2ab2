#include "sysid/changes/filter_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Cholesky>

#include "sysid/fitting/start_estimate.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

constexpr std::array ridges{1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};

using Factor = Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower>;

/// A bin that contains a reading: the index of its record, the index of the bin in this record, and the
/// cross-validation unit of the bin.
struct Row {
  std::size_t record = 0, bin = 0, unit = 0;
};

/// Subtracts the mean value of each record within each cross-validation unit. A model does not predict the
/// zero offset of a run, so the offset must not count as an error.
Eigen::VectorXd centred(Eigen::VectorXd values, const std::vector<Row>& rows) {
  std::map<std::pair<std::size_t, std::size_t>, std::pair<double, double>> sums;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto& [sum, count] = sums[{rows[i].record, rows[i].unit}];
    sum += values(static_cast<Eigen::Index>(i));
    count += 1;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [sum, count] = sums[{rows[i].record, rows[i].unit}];
    values(static_cast<Eigen::Index>(i)) -= sum / count;
  }
  return values;
}

/// The filtered signals of all records, averaged over bins. A row is a bin and belongs to one
/// cross-validation unit.
class FilterBank {
 public:
  FilterBank(const std::vector<Record>& records, const Units& units, FilterKind kind, double bin_s,
             double largest_kpa)
      : unit_indices_(units),
        is_usable_(units.are_runs() || kind == FilterKind::valve),
        units_(units.count()),
        bin_s_(bin_s),
        largest_kpa_(largest_kpa) {
    for (std::size_t r = 0; r < records.size(); ++r) add(records, r, units, kind);
    for (std::size_t u = 0; u < units_; ++u) {
      const Eigen::MatrixXd part = columns_of(u);
      gram_.push_back(Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols()));
      if (part.rows() > 0) gram_[u].selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    }
  }

  /// Residuals of a model, and the weights and errors of the filter bank that is fitted to them.
  struct Target {
    /// Residuals of the model: one element per fit that leaves out a unit, and a last element for the fit to
    /// all units.
    std::vector<Eigen::VectorXd> values;
    /// Right-hand sides of the normal equations of the fits: products of columns and residuals, summed over
    /// rows.
    std::vector<Eigen::VectorXd> moments;
    Eigen::VectorXd plain_left, left, weights;
    std::vector<Eigen::VectorXd> without;  ///< for each unit, the weights of the fit to all other units
    double left_mm = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] Target target_of(const LeftByUnit& left) const {
    Target target;
    for (std::size_t fitted_without = 0; fitted_without <= units_; ++fitted_without) {
      target.values.emplace_back(columns_.rows());
      for (std::size_t i = 0; i < rows_.size(); ++i)
        target.values.back()(static_cast<Eigen::Index>(i)) =
            left[fitted_without][rows_[i].record][rows_[i].bin];
      if (!target.values.back().allFinite()) return {};
      target.moments.push_back(Eigen::VectorXd::Zero(columns_.cols()));
      for (std::size_t u = 0; u < units_; ++u) {
        if (u != fitted_without)
          target.moments.back() += columns_of(u).transpose() * values_of(target.values.back(), u);
      }
    }
    target.plain_left = left_out(target, std::vector(units_, Eigen::VectorXd()));
    target.left = target.plain_left;
    target.left_mm = rms_of(target.left);
    return target;
  }

  /// Fits the filter bank to the residuals of every model. The ridge parameter is the one with the smallest
  /// error in left-out cross-validation units.
  void fit(std::vector<Target>& targets) const {
    for (const double ridge : ridges) {
      std::vector<std::vector<Eigen::VectorXd>> weights(targets.size(), std::vector<Eigen::VectorXd>(units_));
      for (std::size_t u = 0; u < units_; ++u) {
        const Factor factor = factor_without(u, ridge);
        for (std::size_t t = 0; t < targets.size(); ++t) {
          if (!targets[t].moments.empty()) weights[t][u] = factor.solve(targets[t].moments[u]);
        }
      }
      const Factor whole = factor_without(units_, ridge);
      for (std::size_t t = 0; t < targets.size(); ++t) {
        Target& target = targets[t];
        if (target.moments.empty()) continue;
        Eigen::VectorXd left = left_out(target, weights[t]);
        const double rms_mm = rms_of(left);
        if (rms_mm >= target.left_mm) continue;
        target.left_mm = rms_mm;
        target.left = std::move(left);
        target.weights = whole.solve(target.moments[units_]).head(filter_count_);
        target.without.clear();
        for (const Eigen::VectorXd& own : weights[t]) target.without.emplace_back(own.head(filter_count_));
      }
    }
  }

  /// Returns the weights if the filter bank improves the predictions of the model significantly (is_better())
  /// and `is_usable_` is true. Otherwise returns a result without weights.
  [[nodiscard]] FittedFilters answer(Target target, const LeftByUnit& model, std::uint64_t seed) const {
    const std::vector<Eigen::VectorXd> none(units_);
    if (target.values.empty()) return {{}, none, model.back(), std::numeric_limits<double>::infinity()};
    const Binned plain = in_bins(target.plain_left, model.back()), left = in_bins(target.left, model.back());
    if (is_usable_ && is_better(compare(losses_of(plain, left, unit_indices_, bin_s_), 0, seed)))
      return {target.weights, target.without, left, target.left_mm};
    return {{}, none, plain, rms_of(target.plain_left)};
  }

 private:
  void add(const std::vector<Record>& records, std::size_t r, const Units& units, FilterKind kind) {
    const Record& record = records[r];
    const Eigen::MatrixXd filters =
        binned_filter_columns(record, record.drive_kpa, kind, largest_kpa_, bin_s_);
    filter_count_ = filters.cols();
    const std::vector<double> readings = binned(record, record.reading_mm, bin_s_);
    const Eigen::Index first = columns_.rows();
    for (std::size_t b = 0; b < readings.size(); ++b) {
      const double at_s = middle_s(b, bin_s_);
      if (std::isfinite(readings[b]) && at_s > begin_s(record))
        rows_.push_back({r, b, units.unit_of(r, at_s)});
    }
    // Each record gets an additional column for its zero offset.
    const auto count = static_cast<Eigen::Index>(rows_.size());
    columns_.conservativeResize(count, filter_count_ + static_cast<Eigen::Index>(records.size()));
    columns_.bottomRows(count - first).setZero();
    for (Eigen::Index c = 0; c < filter_count_; ++c) {
      for (Eigen::Index i = first; i < count; ++i) {
        const double v = filters(static_cast<Eigen::Index>(rows_[static_cast<std::size_t>(i)].bin), c);
        columns_(i, c) = std::isfinite(v) ? v : 0;
      }
    }
    columns_.col(filter_count_ + static_cast<Eigen::Index>(r))
        .bottomRows(count - first)
        .setConstant(largest_kpa_);
  }

  [[nodiscard]] std::vector<Eigen::Index> rows_of(std::size_t unit) const {
    std::vector<Eigen::Index> indices;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].unit == unit) indices.push_back(static_cast<Eigen::Index>(i));
    }
    return indices;
  }
  [[nodiscard]] Eigen::MatrixXd columns_of(std::size_t unit) const {
    return columns_(rows_of(unit), Eigen::all);
  }
  [[nodiscard]] Eigen::VectorXd values_of(const Eigen::VectorXd& values, std::size_t unit) const {
    return values(rows_of(unit));
  }

  /// Returns the residual of each cross-validation unit. The unit was left out of the fits of model and
  /// weights.
  [[nodiscard]] Eigen::VectorXd left_out(const Target& target,
                                         const std::vector<Eigen::VectorXd>& weights) const {
    Eigen::VectorXd left(columns_.rows());
    for (std::size_t u = 0; u < units_; ++u) {
      for (const Eigen::Index i : rows_of(u)) {
        left(i) = target.values[u](i);
        if (weights[u].size() > 0) left(i) -= columns_.row(i).dot(weights[u]);
      }
    }
    return left;
  }
  [[nodiscard]] Binned in_bins(const Eigen::VectorXd& values, Binned shape) const {
    for (std::vector<double>& series : shape)
      std::fill(series.begin(), series.end(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < rows_.size(); ++i)
      shape[rows_[i].record][rows_[i].bin] = values(static_cast<Eigen::Index>(i));
    return shape;
  }
  [[nodiscard]] double rms_of(const Eigen::VectorXd& left) const {
    return std::sqrt(centred(left, rows_).squaredNorm() / static_cast<double>(left.size()));
  }
  /// Returns the factorised normal equations without the rows of the cross-validation unit `unit`. If `unit`
  /// equals units_, all rows are included.
  [[nodiscard]] Factor factor_without(std::size_t unit, double ridge) const {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
    for (std::size_t u = 0; u < units_; ++u) {
      if (u != unit) gram += gram_[u];
    }
    gram.diagonal().array() += ridge * static_cast<double>(columns_.rows()) * largest_kpa_ * largest_kpa_;
    return gram.selfadjointView<Eigen::Lower>().ldlt();
  }

  Units unit_indices_;
  /// False if there is only one run, because its halves contain similar inputs. Many weights can then fit
  /// both halves well and predict another run badly. The pressure of a valve is an exception, because the
  /// filter bank is the only part of its model.
  bool is_usable_;
  std::size_t units_;
  double bin_s_, largest_kpa_;
  Eigen::MatrixXd columns_;
  std::vector<Eigen::MatrixXd> gram_;  ///< normal matrix of each cross-validation unit
  std::vector<Row> rows_;
  Eigen::Index filter_count_ = 0;
};

}  // namespace

PairedLosses losses_of(const Binned& worse, const Binned& better, const Units& units, double bin_s) {
  std::vector<Row> rows;
  std::vector<double> first, second;
  for (std::size_t r = 0; r < worse.size(); ++r) {
    for (std::size_t b = 0; b < worse[r].size(); ++b) {
      if (!std::isfinite(worse[r][b]) || !std::isfinite(better[r][b])) continue;
      rows.push_back({r, b, units.unit_of(r, middle_s(b, bin_s))});
      first.push_back(worse[r][b]);
      second.push_back(better[r][b]);
    }
  }
  const auto as_vector = [](const std::vector<double>& values) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  const Eigen::VectorXd a = centred(as_vector(first), rows), c = centred(as_vector(second), rows);
  PairedLosses paired;
  std::pair<std::size_t, double> last{0, -1};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::pair block{rows[i].record,
                          std::floor(static_cast<double>(rows[i].bin) * bin_s / units.block_s())};
    if (block != last) paired.begin_block();
    last = block;
    paired.add(a(static_cast<Eigen::Index>(i)), c(static_cast<Eigen::Index>(i)));
  }
  return paired;
}

std::vector<FittedFilters> fit_filters(const std::vector<Record>& records, const Units& units,
                                       FilterKind kind, double bin_s, double largest_kpa,
                                       const std::vector<LeftByUnit>& left, std::uint64_t seed) {
  const FilterBank bank(records, units, kind, bin_s, largest_kpa);
  std::vector<FilterBank::Target> targets;
  targets.reserve(left.size());
  for (const LeftByUnit& model : left) targets.push_back(bank.target_of(model));
  bank.fit(targets);
  std::vector<FittedFilters> fits;
  fits.reserve(left.size());
  for (std::size_t m = 0; m < left.size(); ++m)
    fits.push_back(bank.answer(std::move(targets[m]), left[m], seed));
  return fits;
}

}  // namespace softgrip::sysid
