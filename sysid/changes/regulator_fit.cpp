#include "sysid/changes/regulator_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/fitting/descent.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

constexpr Eigen::Index numbers = 8;
constexpr int most_regulator_steps = 15;
/// Step of the logarithm of a parameter for numerical derivatives, and largest change of this logarithm in
/// one iteration.
constexpr double beside_by = 0.03, longest_move = 1.5;
/// Largest absolute value of the logarithm of (parameter / typical value). It corresponds to a factor of 400.
constexpr double largest_logarithm = 6;
constexpr double least_progress = 0.003;
/// Penalty if a parameter differs from its typical value by a factor of e, as a share of the sum of squared
/// residuals. The penalty keeps a parameter that the readings do not determine at its typical value. For
/// example, the readings do not determine the conductance of a wide tube, because the lags of the filter bank
/// can have the same effect.
constexpr double prior_share = 0.003;

/// Returns the regulator with the coordinates t. A coordinate is the logarithm of (parameter / typical
/// value).
Regulator regulator_at(const Eigen::VectorXd& t, double largest_kpa) {
  const auto times = [&](Eigen::Index i) { return std::exp(t(i)); };
  return {0.002 * largest_kpa * times(0),
          0.01 * largest_kpa * times(1),
          0.2 * largest_kpa * times(2),
          2 * times(3),
          5 * times(4),
          10 * times(5),
          0.01 * times(6),
          0.2 * times(7),
          0};
}

/// Readings averaged over bins, and the fit of a signal behind the regulator to these readings. The signal is
/// that of a finger or of a pressure sensor.
class BinnedReadings {
 public:
  BinnedReadings(const std::vector<Record>& records, double largest_kpa, ReadBy read_by)
      : largest_kpa_(largest_kpa), read_by_(read_by) {
    for (const Record& record : records) {
      const double interval_s = read_by == ReadBy::gauge ? 0.01 : 0.02;
      bin_s_ = std::max(2 * interval_s, 2 * record.mean_interval_s());
      records_.push_back(thinned_to_centres(record, interval_s));
      readings_.push_back(binned(record, record.reading_mm, bin_s_));
      bins_ += readings_.back().size();
    }
  }

  [[nodiscard]] Eigen::VectorXd left_by(const Regulator& regulator) const {
    Eigen::MatrixXd columns;
    Eigen::VectorXd target = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bins_));
    Eigen::Index first = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const Eigen::MatrixXd filters =
          seen(records_[r], regulated(regulator, records_[r], records_[r].drive_kpa));
      if (r == 0)
        columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(bins_),
                                        filters.cols() + static_cast<Eigen::Index>(records_.size()));
      const auto own = static_cast<Eigen::Index>(readings_[r].size());
      // A thinned record may have one bin less than the full record. The last row is then repeated.
      for (Eigen::Index b = 0; b < own; ++b)
        columns.row(first + b).head(filters.cols()) = filters.row(std::min(b, filters.rows() - 1));
      for (Eigen::Index b = 0; b < own; ++b) {
        const double reading = readings_[r][static_cast<std::size_t>(b)];
        columns(first + b, filters.cols() + static_cast<Eigen::Index>(r)) = largest_kpa_;
        if (std::isfinite(reading) && columns.row(first + b).allFinite())
          target(first + b) = reading;
        else
          columns.row(first + b).setZero();
      }
      first += own;
    }
    constexpr double ridge = 1e-6;
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
    gram.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
    gram.diagonal().array() += ridge * static_cast<double>(bins_) * largest_kpa_ * largest_kpa_;
    const Eigen::VectorXd weights =
        gram.selfadjointView<Eigen::Lower>().ldlt().solve(columns.transpose() * target);
    return target - columns * weights;
  }

 private:
  /// Returns the signals that the sensor can have seen behind the regulator, averaged over bins.
  [[nodiscard]] Eigen::MatrixXd seen(const Record& record, const std::vector<double>& drive_kpa) const {
    if (read_by_ == ReadBy::finger)
      return binned_filter_columns(record, drive_kpa, FilterKind::finger, largest_kpa_, bin_s_);
    const std::vector<double> means = binned(record, drive_kpa, bin_s_);
    return Eigen::Map<const Eigen::VectorXd>(means.data(), static_cast<Eigen::Index>(means.size()));
  }

  double largest_kpa_;
  ReadBy read_by_;
  double bin_s_ = 0.04;
  std::vector<Record> records_;
  Binned readings_;
  std::size_t bins_ = 0;
};

/// Search for the parameters of a regulator. The class provides the functions that descend() calls.
class RegulatorSearch {
 public:
  struct Point {
    Eigen::VectorXd t, left;  ///< `t`: coordinates of the search; `left`: residuals, followed by penalties
  };

  RegulatorSearch(const BinnedReadings& bank, double largest_kpa)
      : bank_(bank),
        largest_kpa_(largest_kpa),
        price_(std::sqrt(prior_share) *
               bank.left_by(regulator_at(Eigen::VectorXd::Zero(numbers), largest_kpa)).norm()) {}

  [[nodiscard]] Point at(const Eigen::VectorXd& t) const {
    const Eigen::VectorXd readings = bank_.left_by(regulator_at(t, largest_kpa_));
    Point point{t, Eigen::VectorXd(readings.size() + numbers)};
    point.left << readings, price_ * t;
    return point;
  }

  [[nodiscard]] static double loss(const Point& point) { return point.left.squaredNorm(); }

  [[nodiscard]] NormalEquations normal(const Point& point) const {
    Eigen::MatrixXd jacobian(point.left.size(), numbers);
    for (Eigen::Index k = 0; k < numbers; ++k) {
      Eigen::VectorXd beside = point.t;
      beside(k) += beside_by;
      jacobian.col(k) = (at(beside).left - point.left) / beside_by;
    }
    return {jacobian.transpose() * point.left, jacobian.transpose() * jacobian};
  }

  [[nodiscard]] static StepBounds bounds(const Point& point) {
    return {-largest_logarithm - point.t.array(), largest_logarithm - point.t.array()};
  }

  [[nodiscard]] Point moved(const Point& from, const Eigen::VectorXd& step) const {
    return at(from.t + step);
  }

 private:
  const BinnedReadings& bank_;
  double largest_kpa_;
  double price_;
};

}  // namespace

Regulator fit_regulator(const std::vector<Record>& records, double largest_kpa, ReadBy read_by) {
  const BinnedReadings bank(records, largest_kpa, read_by);
  RegulatorSearch search(bank, largest_kpa);
  const auto end = descend(search, search.at(Eigen::VectorXd::Zero(numbers)),
                           {.most_steps = most_regulator_steps,
                            .most_trials = 4,
                            .longest_step = longest_move,
                            .least_share = least_progress,
                            .least_damping = 1.0 / numbers});
  return regulator_at(end.point.t, largest_kpa);
}

}  // namespace softgrip::sysid
