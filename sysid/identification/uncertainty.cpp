#include "sysid/identification/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "base/parallel.h"
#include "base/statistics.h"
#include "sysid/fitting/residuals.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Coordinates in which the least-squares problem is well conditioned. With J the Jacobian and B the rows of
/// J that have a curvature, the singular value decomposition is B S = U D V', where S scales each column to a
/// length of 1. The coordinates y are given by z = T y with T = S V D^-1, so that (B'B)^-1 = T T'. The
/// products J'J are never formed, because their rounding errors are larger than the information about a
/// direction that the data hardly determine.
struct Coordinates {
  MatrixXd to_z;             ///< T, for the parameters that were kept
  std::vector<bool> unseen;  ///< per coordinate, true: a change along it changes no residual measurably
};

/// Largest effect of a parameter that counts as no effect, as a share of the noise. The effect is the norm of
/// the change of all residuals, and the noise is the norm of the noise in all residuals.
constexpr double negligible_effect = 1e-6;

/// Number of rows that are processed together. These rows fit into the cache of a processor.
constexpr Index rows_at_once = 1024;

/// Returns the upper triangular factor R of a QR decomposition of the columns `keep` of a matrix, without the
/// rows that have no curvature. The rows are added in groups: R of all rows up to a group is the factor of
/// the previous R and the group.
MatrixXd triangular_factor(const Jacobian& all, const std::vector<Index>& keep,
                           const std::vector<bool>& is_curved) {
  const auto n = static_cast<Index>(keep.size());
  MatrixXd stacked = MatrixXd::Zero(n + rows_at_once, n);
  for (Index first = 0; first < all.rows(); first += rows_at_once) {
    for (Index i = 0; i < rows_at_once; ++i) {
      const Index row = first + i;
      const bool counts = row < all.rows() && is_curved[static_cast<std::size_t>(row)];
      for (Index k = 0; k < n; ++k)
        stacked(n + i, k) = counts ? all(row, keep[static_cast<std::size_t>(k)]) : 0.0;
    }
    const MatrixXd upper =
        Eigen::HouseholderQR<MatrixXd>(stacked).matrixQR().topRows(n).triangularView<Eigen::Upper>();
    stacked.topRows(n) = upper;
  }
  return stacked.topRows(n);
}

/// @param upper  triangular factor of B.
Coordinates coordinates_of(const MatrixXd& upper) {
  // Share of the largest singular value below which a singular value cannot be distinguished from the
  // rounding errors of the simulation. This lower limit keeps the standard deviation of such a direction
  // finite, but very large.
  constexpr double resolution = 1e-10;
  const Eigen::VectorXd scale = upper.colwise().norm().transpose().cwiseMax(1e-150).cwiseInverse();
  const Eigen::JacobiSVD<MatrixXd> svd(MatrixXd(upper * scale.asDiagonal()), Eigen::ComputeFullV);
  const double smallest = std::max(resolution * svd.singularValues()(0), 1e-300);
  Coordinates c{scale.asDiagonal() * svd.matrixV(), {}};
  for (Index k = 0; k < c.to_z.cols(); ++k) {
    const double size = svd.singularValues()(k);
    c.unseen.push_back(!(size > smallest));
    c.to_z.col(k) /= std::max(size, smallest);
  }
  return c;
}

/// Computes products of the noise covariance C and the Jacobian W for each record. W contains the derivatives
/// of the residuals with respect to the coordinates y. If A is the whitening filter of the autoregressive
/// model, then C = s^2 (A'A)^-1. Therefore C W is s^2 times W after two passes of the filter 1/A, first
/// backwards and then forwards in time.
class CorrelatedNoise {
 public:
  CorrelatedNoise(const Jacobian& jacobian, const std::vector<std::size_t>& rows)
      : jacobian_(jacobian), rows_(rows) {}

  /// Returns W after the backward pass of the filter.
  [[nodiscard]] Jacobian filtered(const NoiseModel& noise) const {
    Jacobian x = jacobian_;
    for_each_record([&](Index first, Index count) { backwards(x.middleRows(first, count), noise); });
    return x;
  }

  /// Returns the covariance W' C W of the estimates in the coordinates y.
  /// @param filtered  filtered(noise).
  [[nodiscard]] static MatrixXd product(const Jacobian& filtered, const NoiseModel& noise) {
    return noise.innovation_mm * noise.innovation_mm * (filtered.transpose() * filtered);
  }

  /// Increases the autocovariances of the residuals by the part of the noise that the fit has absorbed. With
  /// the noise covariance C, the covariance of the residuals is (I - H) C (I - H), where H = W W'.
  /// @param filtered  filtered(noise).
  /// @param meat  product(filtered, noise).
  void give_back(Jacobian filtered, const NoiseModel& noise, const MatrixXd& meat,
                 Autocovariance& covariance) const {
    for_each_record([&](Index first, Index count) { forwards(filtered.middleRows(first, count), noise); });
    const double s2 = noise.innovation_mm * noise.innovation_mm;
    for_each_record([&](Index first, Index count) {
      const auto w = jacobian_.middleRows(first, count);
      const auto cw = filtered.middleRows(first, count);
      const Jacobian rest = s2 * cw - w * meat;
      const auto lags = static_cast<Index>(covariance.lags.size());
      const Index groups = (count + rows_at_once - 1) / rows_at_once;
      MatrixXd taken = MatrixXd::Zero(lags, groups);
      parallel_for_idle(static_cast<std::size_t>(groups), [&](std::size_t group) {
        const Index g = static_cast<Index>(group), from = g * rows_at_once;
        for (Index lag = 0; lag < lags; ++lag) {
          const Index n = std::min(rows_at_once, count - from - lag);
          if (n <= 0) break;
          taken(lag, g) = s2 * w.middleRows(from, n).cwiseProduct(cw.middleRows(from + lag, n)).sum() +
                          rest.middleRows(from, n).cwiseProduct(w.middleRows(from + lag, n)).sum();
        }
      });
      for (Index lag = 0; lag < lags; ++lag)
        covariance.lags[static_cast<std::size_t>(lag)] +=
            taken.row(lag).sum() / static_cast<double>(covariance.samples);
    });
  }

 private:
  template <class Work>
  void for_each_record(Work&& work) const {
    Index first = 0;
    for (const std::size_t count : rows_) {
      work(first, static_cast<Index>(count));
      first += static_cast<Index>(count);
    }
  }
  using Rows = Jacobian::RowsBlockXpr;
  static void backwards(Rows x, const NoiseModel& noise) {
    for_columns_of(x, [&]<class Columns>(Columns columns) {
      for (Index t = columns.rows(); t-- > 0;) {
        RowOf<Columns> sum = columns.row(t);
        const Index reach = std::min(order_of(noise), columns.rows() - 1 - t);
        for (Index lag = 1; lag <= reach; ++lag)
          sum += noise.coefficients[static_cast<std::size_t>(lag - 1)] * columns.row(t + lag);
        columns.row(t) = sum;
      }
    });
  }
  static void forwards(Rows x, const NoiseModel& noise) {
    for_columns_of(x, [&]<class Columns>(Columns columns) {
      for (Index t = 0; t < columns.rows(); ++t) {
        RowOf<Columns> sum = columns.row(t);
        const Index reach = std::min(order_of(noise), t);
        for (Index lag = 1; lag <= reach; ++lag)
          sum += noise.coefficients[static_cast<std::size_t>(lag - 1)] * columns.row(t - lag);
        columns.row(t) = sum;
      }
    });
  }
  static Index order_of(const NoiseModel& noise) { return static_cast<Index>(noise.coefficients.size()); }

  /// Number of columns that are filtered together: the values in a cache line.
  static constexpr int together = 8;
  /// A row of a group of columns. It is stored without a heap allocation.
  template <class Columns>
  using RowOf = Eigen::Matrix<double, 1, Columns::ColsAtCompileTime, Eigen::RowMajor, 1, together>;
  /// Calls work(columns) for groups of columns. The columns are filtered independently.
  template <class Work>
  static void for_columns_of(Rows x, Work&& work) {
    parallel_for_idle(static_cast<std::size_t>((x.cols() + together - 1) / together), [&](std::size_t group) {
      const Index first = static_cast<Index>(group) * together;
      if (first + together <= x.cols())
        work(x.middleCols<together>(first));
      else
        work(x.rightCols(x.cols() - first));
    });
  }

  const Jacobian& jacobian_;
  const std::vector<std::size_t>& rows_;
};

/// Returns a square root of the covariance of the estimates in the coordinates y. The covariance is the root
/// times its transpose, so that the variance of no combination of parameters can be negative.
MatrixXd root_of(MatrixXd meat, const Coordinates& coordinates, const NoiseModel& noise) {
  for (std::size_t k = 0; k < coordinates.unseen.size(); ++k) {
    if (!coordinates.unseen[k]) continue;
    // A variance of 0 would mean that the data determine the coordinate exactly.
    const auto at = static_cast<Index>(k);
    meat(at, at) = noise.deviation_mm * noise.deviation_mm;
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(meat);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// Returns the directions in which the data determine the estimate poorly. In such a direction, the standard
/// deviation of the estimate is at least 0.5 in the scale of the fit. This is half a typical change, or a
/// factor of 1.6 on a logarithmic scale.
std::vector<LooseDirection> loose_directions(const MatrixXd& root, const std::vector<Index>& keep,
                                             const FitSpace& space) {
  constexpr double loose_from = 0.5;
  std::vector<LooseDirection> loose;
  const Eigen::JacobiSVD<MatrixXd> svd(root, Eigen::ComputeFullU);
  for (Index i = 0; i < root.rows(); ++i) {
    const double deviation = svd.singularValues()(i);
    if (deviation < loose_from) break;
    const Eigen::VectorXd direction = svd.matrixU().col(i);
    std::vector<Index> order(static_cast<std::size_t>(direction.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return std::abs(direction(a)) > std::abs(direction(b)); });
    LooseDirection found;
    found.deviation = deviation;
    for (const Index at : order) {
      if (std::abs(direction(at)) < 0.25) break;
      found.names.push_back(space.free()[static_cast<std::size_t>(keep[static_cast<std::size_t>(at)])].name);
      found.weights.push_back(direction(at));
    }
    loose.push_back(std::move(found));
  }
  return loose;
}

}  // namespace

Uncertainty uncertainty_at(const Residuals& residuals, const std::vector<double>& z, double huber_mm) {
  const auto n = static_cast<Index>(z.size());
  const std::size_t rows = residuals.count();
  Uncertainty u{MatrixXd::Zero(n, 0),
                Eigen::VectorXd::Zero(n),
                Eigen::VectorXd::Zero(n),
                std::vector<bool>(z.size()),
                std::vector<bool>(z.size()),
                {},
                limits::deviate,
                {}};
  Jacobian jacobian(static_cast<Index>(rows), n);
  std::vector<double> r(rows);
  if (!residuals.evaluate(z, r, {jacobian.data(), rows * z.size()})) return u;

  // In the linear range of Huber's loss, a sample adds a constant to the gradient and nothing to the
  // curvature.
  std::vector<bool> is_curved(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    is_curved[i] = std::abs(r[i]) <= huber_mm;
    if (!is_curved[i]) r[i] = std::copysign(huber_mm, r[i]);
  }
  std::vector<std::span<const double>> series;
  std::vector<std::size_t> counts;
  std::size_t first = 0;
  for (const Record& record : residuals.records()) {
    series.emplace_back(&r[first], record.readings);
    counts.push_back(record.readings);
    first += record.readings;
  }
  const Autocovariance observed = autocovariance_of(series);
  u.noise = fit_noise(observed);

  std::vector<Index> keep;
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(n);
  for (Index row = 0; row < jacobian.rows(); ++row) squares += jacobian.row(row).cwiseAbs2();
  const double noise_norm_mm = u.noise.deviation_mm * std::sqrt(static_cast<double>(rows));
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const FreeParameter& p = residuals.space().free()[at];
    const double tolerance = 1e-6 * std::max(1.0, std::abs(z[at]));
    const double column_mm = std::sqrt(squares(i));
    u.without_effect[at] = !(column_mm * (p.upper_z() - p.lower_z()) > negligible_effect * noise_norm_mm);
    if (!u.without_effect[at]) u.lone_deviation(i) = u.noise.deviation_mm / column_mm;
    u.at_bound[at] = z[at] <= p.lower_z() + tolerance || z[at] >= p.upper_z() - tolerance;
    if (!u.without_effect[at] && !u.at_bound[at]) keep.push_back(i);
  }
  if (keep.empty()) return u;
  const Coordinates coordinates = coordinates_of(triangular_factor(jacobian, keep, is_curved));
  MatrixXd to_all = MatrixXd::Zero(n, coordinates.to_z.cols());
  for (std::size_t i = 0; i < keep.size(); ++i)
    to_all.row(keep[i]) = coordinates.to_z.row(static_cast<Index>(i));
  Jacobian columns = jacobian * to_all;
  for (Index k = 0; k < columns.cols(); ++k) {
    // The computed effect of an unseen coordinate consists of rounding errors.
    if (coordinates.unseen[static_cast<std::size_t>(k)]) columns.col(k).setZero();
  }
  const CorrelatedNoise correlated(columns, counts);
  Jacobian filtered = correlated.filtered(u.noise);
  MatrixXd meat = CorrelatedNoise::product(filtered, u.noise);
  // The residuals are smaller and less correlated than the noise, because the fit has absorbed part of the
  // noise. The correction for the absorbed part uses lags up to the order of the model plus this number.
  constexpr std::size_t lags_beyond = 5;
  for (int pass = 0; pass < 2; ++pass) {
    Autocovariance whole = observed;
    whole.lags.resize(std::min(whole.lags.size(), u.noise.coefficients.size() + lags_beyond));
    correlated.give_back(std::move(filtered), u.noise, meat, whole);
    u.noise = fit_noise(whole);
    filtered = correlated.filtered(u.noise);
    meat = CorrelatedNoise::product(filtered, u.noise);
  }
  const MatrixXd root = coordinates.to_z * root_of(meat, coordinates, u.noise);
  u.root = MatrixXd::Zero(n, root.cols());
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const auto row = static_cast<Index>(i);
    u.root.row(keep[i]) = root.row(row);
    u.white_variance(keep[i]) =
        u.noise.deviation_mm * u.noise.deviation_mm * coordinates.to_z.row(row).squaredNorm();
  }
  u.quantile = t_quantile(u.noise.effective_samples - static_cast<double>(keep.size()));
  u.loose = loose_directions(root, keep, residuals.space());
  return u;
}

}  // namespace softgrip::sysid
