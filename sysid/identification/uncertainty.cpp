#include "sysid/identification/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "base/statistics.h"
#include "sysid/fitting/bounded_solve.h"
#include "sysid/fitting/jacobian.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Computes products of the noise covariance C and the Jacobian J for each record. If A is the whitening
/// filter of the autoregressive model, then C = s^2 (A'A)^-1. Therefore C J is s^2 times J after two passes
/// of the filter 1/A, first backwards and then forwards in time.
class CorrelatedNoise {
 public:
  CorrelatedNoise(const Jacobian& jacobian, const std::vector<std::size_t>& rows)
      : jacobian_(jacobian), rows_(rows) {}

  /// Returns the product J' C J of the Jacobian J and the noise covariance C.
  [[nodiscard]] MatrixXd product(const NoiseModel& noise) const {
    MatrixXd sum = MatrixXd::Zero(jacobian_.cols(), jacobian_.cols());
    for_each_record([&](Index first, Index count) {
      const Jacobian x = backwards(jacobian_.middleRows(first, count), noise);
      sum.noalias() += x.transpose() * x;
    });
    return noise.innovation_mm * noise.innovation_mm * sum;
  }

  /// Increases the autocovariances of the residuals by the part of the noise that the fit has absorbed. With
  /// the noise covariance C, the covariance of the residuals is (I - H) C (I - H), where H = J (J'J)^-1 J'
  /// and J is the Jacobian.
  void give_back(const NoiseModel& noise, const MatrixXd& inverse, const MatrixXd& meat,
                 Autocovariance& covariance) const {
    const double s2 = noise.innovation_mm * noise.innovation_mm;
    const MatrixXd both = inverse * meat * inverse;
    for_each_record([&](Index first, Index count) {
      const auto j = jacobian_.middleRows(first, count);
      const Jacobian cj = s2 * forwards(backwards(j, noise), noise);
      const Jacobian jm = j * inverse;
      const Jacobian jk = j * both;
      for (std::size_t lag = 0; lag < covariance.lags.size(); ++lag) {
        const Index n = count - static_cast<Index>(lag);
        if (n <= 0) break;
        const double taken = jm.topRows(n).cwiseProduct(cj.bottomRows(n)).sum() +
                             cj.topRows(n).cwiseProduct(jm.bottomRows(n)).sum() -
                             jk.topRows(n).cwiseProduct(j.bottomRows(n)).sum();
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

void scatter(const MatrixXd& part, const std::vector<Index>& keep, MatrixXd& whole) {
  for (std::size_t i = 0; i < keep.size(); ++i) {
    for (std::size_t j = 0; j < keep.size(); ++j) {
      whole(keep[i], keep[j]) = part(static_cast<Index>(i), static_cast<Index>(j));
    }
  }
}

/// Returns the directions in which the data determine the estimate poorly. In such a direction, the standard
/// deviation of the estimate is at least 0.5 in the scale of the fit. This is half a typical change, or a
/// factor of 1.6 on a logarithmic scale.
std::vector<LooseDirection> loose_directions(const MatrixXd& covariance, const std::vector<Index>& keep,
                                             const FitSpace& space) {
  constexpr double loose_from = 0.5;
  std::vector<LooseDirection> loose;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(covariance);
  for (Index i = covariance.rows(); i-- > 0;) {
    const double deviation = std::sqrt(std::max(solver.eigenvalues()(i), 0.0));
    if (deviation < loose_from) break;
    const Eigen::VectorXd direction = solver.eigenvectors().col(i);
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
  Uncertainty u{MatrixXd::Zero(n, n),
                MatrixXd::Zero(n, n),
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
  const double largest = jacobian.colwise().norm().maxCoeff();
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const FreeParameter& p = residuals.space().free()[at];
    const double tolerance = 1e-6 * std::max(1.0, std::abs(z[at]));
    u.without_effect[at] = jacobian.col(i).norm() <= 1e-9 * largest;
    u.at_bound[at] = z[at] <= p.lower_z() + tolerance || z[at] >= p.upper_z() - tolerance;
    if (!u.without_effect[at] && !u.at_bound[at]) keep.push_back(i);
  }
  if (keep.empty()) return u;
  const MatrixXd gram = kept(MatrixXd(bread.transpose() * bread), keep);
  const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  scaled.diagonal().array() += 1e-13;
  const MatrixXd inverse = scale.asDiagonal() *
                           scaled.ldlt().solve(MatrixXd::Identity(gram.rows(), gram.cols())).eval() *
                           scale.asDiagonal();
  Jacobian columns(jacobian.rows(), static_cast<Index>(keep.size()));
  for (std::size_t i = 0; i < keep.size(); ++i) columns.col(static_cast<Index>(i)) = jacobian.col(keep[i]);
  const CorrelatedNoise correlated(columns, counts);
  MatrixXd meat = correlated.product(u.noise);
  // The residuals are smaller and less correlated than the noise, because the fit has absorbed part of the
  // noise. The correction for the absorbed part uses lags up to the order of the model plus this number.
  constexpr std::size_t lags_beyond = 5;
  for (int pass = 0; pass < 2; ++pass) {
    Autocovariance whole = observed;
    whole.lags.resize(std::min(whole.lags.size(), u.noise.coefficients.size() + lags_beyond));
    correlated.give_back(u.noise, inverse, meat, whole);
    u.noise = fit_noise(whole);
    meat = correlated.product(u.noise);
  }
  const MatrixXd covariance = inverse * meat * inverse;
  scatter(covariance, keep, u.covariance);
  scatter(inverse * u.noise.deviation_mm * u.noise.deviation_mm, keep, u.naive);
  u.quantile = t_quantile(u.noise.effective_samples - static_cast<double>(keep.size()));
  u.loose = loose_directions(covariance, keep, residuals.space());
  return u;
}

}  // namespace softgrip::sysid
