#include "sysid/diagnosis/experiments/separation.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/resampled_record.h"

namespace softgrip::sysid {
namespace {

/// Relative increase of the diagonal elements of the information matrix. With this increase, the linear
/// system has a solution even if the data do not determine some combination of parameters.
constexpr double ridge = 1e-9;
constexpr FitEffort few_iterations{.most_iterations = 10, .tolerance = 1e-6};

/// Whitens each column of a matrix with the noise model, in the rows from `first` to before `last`.
void whiten(Jacobian& matrix, std::size_t first, std::size_t last, const NoiseModel& noise) {
  const std::vector<double>& a = noise.coefficients;
  const auto row = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  for (std::size_t i = last; i-- > first;) {
    const std::size_t lags = std::min(a.size(), i - first);
    for (std::size_t k = 1; k <= lags; ++k) matrix.row(row(i)) -= a[k - 1] * matrix.row(row(i - k));
    matrix.row(row(i)) /= noise.innovation_mm;
  }
}

/// Returns the Jacobian of all readings. The rows of each record are whitened separately. The result is empty
/// if the prediction of the model is not finite.
Jacobian whitened_jacobian(const std::vector<Record>& records, const FitSpace& space, const FitPoint& point,
                           const NoiseModel& noise) {
  const auto residuals = residuals_for(records, space);
  Jacobian jacobian(static_cast<Eigen::Index>(residuals->count()), static_cast<Eigen::Index>(space.size()));
  std::vector<double> r(residuals->count());
  const std::vector<double> z = space.z(point);
  const std::span<double> flat(jacobian.data(), static_cast<std::size_t>(jacobian.size()));
  if (!residuals->evaluate(z, r, flat)) return {};
  std::size_t first = 0;
  for (const Record& record : records) {
    const std::size_t last = first + record.readings;
    whiten(jacobian, first, last, noise);
    first = last;
  }
  return jacobian;
}

/// Eliminates all parameters except the first `keep` parameters from an information matrix. Returns the
/// remaining matrix with `keep` rows.
Eigen::MatrixXd eliminated(const Eigen::MatrixXd& information, Eigen::Index keep) {
  const Eigen::Index rest = information.rows() - keep;
  if (rest == 0) return information;
  Eigen::MatrixXd corner = information.bottomRightCorner(rest, rest);
  corner.diagonal() *= 1 + ridge;
  corner.diagonal().array() += 1e-12;
  const Eigen::MatrixXd side = information.topRightCorner(keep, rest);
  return information.topLeftCorner(keep, keep) - side * corner.ldlt().solve(side.transpose());
}

double norm(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum);
}

}  // namespace

std::vector<double> whitened(const std::vector<double>& series, const NoiseModel& noise) {
  std::vector<double> white = series;
  for (std::size_t i = 0; i < series.size(); ++i) {
    for (std::size_t k = 1; k <= std::min(i, noise.coefficients.size()); ++k)
      white[i] -= noise.coefficients[k - 1] * series[i - k];
    white[i] /= noise.innovation_mm;
  }
  return white;
}

Hypothesis::Hypothesis(const std::vector<Record>& records, StructureFit fit, const NoiseModel& noise)
    : records_(records), fit_(std::move(fit)), noise_(noise) {
  free_ = fitted_indices(fit_.point.model, fit_.causes);
  const FitSpace space(fit_.point.model, records_, free_);
  const Jacobian jacobian = whitened_jacobian(records_, space, fit_.point, noise_);
  const auto keep = static_cast<Eigen::Index>(free_.size());
  information_ = jacobian.size() == 0 ? Eigen::MatrixXd::Zero(keep, keep)
                                      : eliminated(jacobian.transpose() * jacobian, keep);
}

std::vector<double> Hypothesis::prediction(const Record& record) const {
  return predict(fit_.point.model, record, rest_starts(fit_.point.model, {record}).front());
}

double Hypothesis::linear_distance(const Record& record, const std::vector<double>& truth_mm) const {
  std::vector<Record> records{record};
  records[0].reading_mm = truth_mm;
  records[0].readings = truth_mm.size();
  const std::vector<double> own = prediction(record);
  std::vector<double> difference(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) difference[i] = truth_mm[i] - own[i];
  const std::vector<double> white = whitened(difference, noise_);
  const Eigen::Map<const Eigen::VectorXd> d(white.data(), static_cast<Eigen::Index>(white.size()));

  const FitSpace space(fit_.point.model, records, free_);
  const FitPoint point{fit_.point.model, rest_starts(fit_.point.model, records)};
  const Jacobian jacobian = whitened_jacobian(records, space, point, noise_);
  if (jacobian.size() == 0) return norm(white);
  Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  const auto known = static_cast<Eigen::Index>(free_.size());
  information.topLeftCorner(known, known) += information_;
  information.diagonal() *= 1 + ridge;
  information.diagonal().array() += 1e-12;
  const Eigen::VectorXd b = jacobian.transpose() * d;
  return std::sqrt(std::max(0.0, d.squaredNorm() - b.dot(information.ldlt().solve(b))));
}

double Hypothesis::refitted_distance(const Record& record, const std::vector<double>& truth_mm) const {
  const double interval_s = limits::finger_interval_in_units * time_unit_s(records_);
  std::vector<Record> records;
  for (const Record& old : records_) records.push_back(thinned_to(old, interval_s));
  records.push_back(record);
  records.back().reading_mm = truth_mm;
  records.back().readings = truth_mm.size();
  records.back() = thinned_to(records.back(), interval_s);
  FitPoint point = fit_.point;
  point.starts.push_back(rest_starts(point.model, {record}).front());
  const StructureFit refitted = fit_structure(records, fit_.causes, point, few_iterations);
  const std::vector<double> own = predict(refitted.point.model, record, refitted.point.starts.back());
  std::vector<double> difference(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) difference[i] = truth_mm[i] - own[i];
  return norm(whitened(difference, noise_));
}

}  // namespace softgrip::sysid
