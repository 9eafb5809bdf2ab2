#include "sysid/identification/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "base/statistics.h"
#include "sysid/fitting/jacobian.h"
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

Coordinates coordinates_of(const MatrixXd& bread) {
  // Share of the largest singular value below which a singular value cannot be distinguished from the
  // rounding errors of the simulation. This lower limit keeps the standard deviation of such a direction
  // finite, but very large.
  constexpr double resolution = 1e-10;
  const Eigen::VectorXd scale = bread.colwise().norm().transpose().cwiseMax(1e-150).cwiseInverse();
  MatrixXd scaled = MatrixXd::Zero(std::max(bread.rows(), bread.cols()), bread.cols());
  scaled.topRows(bread.rows()) = bread * scale.asDiagonal();
  const MatrixXd upper =
      Eigen::HouseholderQR<MatrixXd>(scaled).matrixQR().topRows(scaled.cols()).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixXd> svd(upper, Eigen::ComputeFullV);
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

  /// Returns the covariance W' C W of the estimates in the coordinates y.
  [[nodiscard]] MatrixXd product(const NoiseModel& noise) const {
    MatrixXd sum = MatrixXd::Zero(jacobian_.cols(), jacobian_.cols());
    for_each_record([&](Index first, Index count) {
      const Jacobian x = backwards(jacobian_.middleRows(first, count), noise);
      sum.noalias() += x.transpose() * x;
    });
    return noise.innovation_mm * noise.innovation_mm * sum;
  }

  /// Increases the autocovariances of the residuals by the part of the noise that the fit has absorbed. With
  /// the noise covariance C, the covariance of the residuals is (I - H) C (I - H), where H = W W'.
  void give_back(const NoiseModel& noise, const MatrixXd& meat, Autocovariance& covariance) const {
    const double s2 = noise.innovation_mm * noise.innovation_mm;
    for_each_record([&](Index first, Index count) {
      const auto w = jacobian_.middleRows(first, count);
      const Jacobian cw = s2 * forwards(backwards(w, noise), noise);
      const Jacobian wm = w * meat;
      for (std::size_t lag = 0; lag < covariance.lags.size(); ++lag) {
        const Index n = count - static_cast<Index>(lag);
        if (n <= 0) break;
        const double taken = w.topRows(n).cwiseProduct(cw.bottomRows(n)).sum() +
                             cw.topRows(n).cwiseProduct(w.bottomRows(n)).sum() -
                             wm.topRows(n).cwiseProduct(w.bottomRows(n)).sum();
        covariance.lags[lag] += taken / static_cast<double>(covariance.samples);
      }
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
  static Jacobian backwards(Jacobian x, const NoiseModel& noise) {
    const auto order = static_cast<Index>(noise.coefficients.size());
    for (Index t = x.rows(); t-- > 0;) {
      const Index reach = std::min(order, x.rows() - 1 - t);
      for (Index lag = 1; lag <= reach; ++lag) {
        x.row(t) += noise.coefficients[static_cast<std::size_t>(lag - 1)] * x.row(t + lag);
      }
    }
    return x;
  }
  static Jacobian forwards(Jacobian x, const NoiseModel& noise) {
    const auto order = static_cast<Index>(noise.coefficients.size());
    for (Index t = 0; t < x.rows(); ++t) {
      const Index reach = std::min(order, t);
      for (Index lag = 1; lag <= reach; ++lag) {
        x.row(t) += noise.coefficients[static_cast<std::size_t>(lag - 1)] * x.row(t - lag);
      }
    }
    return x;
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
  double curved = 0;
  Jacobian bread = jacobian;
  for (std::size_t i = 0; i < rows; ++i) {
    if (std::abs(r[i]) <= huber_mm) {
      ++curved;
    } else {
      bread.row(static_cast<Index>(i)).setZero();
      r[i] = std::copysign(huber_mm, r[i]);
    }
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
  const double largest = n > 0 ? jacobian.colwise().norm().maxCoeff() : 0;
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const FreeParameter& p = residuals.space().free()[at];
    const double tolerance = 1e-6 * std::max(1.0, std::abs(z[at]));
    u.without_effect[at] = jacobian.col(i).norm() <= 1e-9 * largest;
    u.at_bound[at] = z[at] <= p.lower_z() + tolerance || z[at] >= p.upper_z() - tolerance;
    if (!u.without_effect[at] && !u.at_bound[at]) keep.push_back(i);
  }
  if (keep.empty()) return u;
  const auto columns_of = [&](const Jacobian& all) {
    MatrixXd columns(all.rows(), static_cast<Index>(keep.size()));
    for (std::size_t i = 0; i < keep.size(); ++i) columns.col(static_cast<Index>(i)) = all.col(keep[i]);
    return columns;
  };
  const Coordinates coordinates = coordinates_of(columns_of(bread));
  Jacobian columns = columns_of(jacobian) * coordinates.to_z;
  for (Index k = 0; k < columns.cols(); ++k) {
    // The computed effect of an unseen coordinate consists of rounding errors.
    if (coordinates.unseen[static_cast<std::size_t>(k)]) columns.col(k).setZero();
  }
  const CorrelatedNoise correlated(columns, counts);
  MatrixXd meat = correlated.product(u.noise);
  // The residuals are smaller and less correlated than the noise, because the fit has absorbed part of the
  // noise. The correction for the absorbed part uses lags up to the order of the model plus this number.
  constexpr std::size_t lags_beyond = 5;
  for (int pass = 0; pass < 2; ++pass) {
    Autocovariance whole = observed;
    whole.lags.resize(std::min(whole.lags.size(), u.noise.coefficients.size() + lags_beyond));
    correlated.give_back(u.noise, meat, whole);
    u.noise = fit_noise(whole);
    meat = correlated.product(u.noise);
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
