#include "sysid/diagnosis/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/catalogue.h"
#include "sysid/residuals.h"
#include "sysid/trajectory.h"

namespace softgrip::sysid {
namespace {

/// Of the diagonal of the normal matrix; along directions that the data hardly show, no step is worth having.
constexpr double damping = 1e-3;
constexpr double least_size = 0.7;
constexpr double largest_size = 1.4;

}  // namespace

Scan::Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place)
    : records_(records), place_(std::move(place)) {
  const FitSpace space = structure_space(records_, place_.model, causes);
  const auto residuals = residuals_for(records_, space);
  const auto rows = static_cast<Eigen::Index>(residuals->count());
  const auto columns = static_cast<Eigen::Index>(space.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(rows, columns);
  residual_.resize(rows);
  usable_ = residuals->evaluate(space.z(place_), {residual_.data(), residuals->count()},
                                {jacobian.data(), residuals->count() * space.size()});
  if (!usable_) return;
  jacobian_ = jacobian;
  Eigen::MatrixXd normal = jacobian_.transpose() * jacobian_;
  normal.diagonal() *= 1 + damping;
  normal.diagonal().array() += 1e-12;
  normal_.compute(normal);
  left_ = left_of(residual_);
}

Eigen::VectorXd Scan::left_of(const Eigen::VectorXd& v) const {
  return v - jacobian_ * normal_.solve(jacobian_.transpose() * v);
}

Eigen::VectorXd Scan::residual_at(const model::Model& model) const {
  Eigen::VectorXd r(residual_.size());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const std::vector<double> prediction = predict(model, records_[k], place_.starts[k]);
    for (std::size_t i = 0; i < prediction.size(); ++i) {
      if (std::isfinite(records_[k].reading_mm[i])) r[row++] = prediction[i] - records_[k].reading_mm[i];
    }
  }
  return r;
}

double Scan::mean_square_with(const model::BlockSpec& block) const {
  const model::Model model = model::with_block(place_.model, block);
  constexpr double unknown = std::numeric_limits<double>::infinity();
  if (!usable_ || !model::validate(model).empty()) return unknown;
  const Eigen::VectorXd effect = left_of(residual_at(model) - residual_);
  const double own = effect.squaredNorm();
  if (!std::isfinite(own)) return unknown;
  const double size = own > 0 ? std::clamp(-left_.dot(effect) / own, least_size, largest_size) : 1;
  return (left_ + size * effect).squaredNorm() / static_cast<double>(residual_.size());
}

std::vector<FitPoint> best_starts(std::span<const Scan> scans, const Cause& cause, const Scales& scales,
                                  std::size_t count) {
  const std::vector<CauseStart> starts = cause_starts(cause, scales);
  std::vector<FitPoint> points;
  const auto add = [&](const Scan& scan, const model::BlockSpec& block) {
    points.push_back(scan.place());
    points.back().model = model::with_block(points.back().model, block);
  };
  const std::size_t of_each = std::max<std::size_t>(1, count / std::max<std::size_t>(1, scans.size()));
  for (const Scan& scan : scans) {
    std::vector<std::pair<double, const model::BlockSpec*>> scored;
    for (const CauseStart& start : starts) {
      if (has_free_form(cause, start.block)) continue;
      const double square = scan.mean_square_with(start.block);
      if (std::isfinite(square)) scored.emplace_back(square, &start.block);
    }
    std::stable_sort(scored.begin(), scored.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < std::min(of_each, scored.size()); ++i) add(scan, *scored[i].second);
  }
  for (const CauseStart& start : starts) {
    if (has_free_form(cause, start.block) && !scans.empty() && scans.front().usable())
      add(scans.front(), start.block);
  }
  return points;
}

}  // namespace softgrip::sysid
