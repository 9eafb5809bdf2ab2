#include "sysid/diagnosis/search/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "model/catalogue.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

constexpr double least_size = 0.7;
constexpr double largest_size = 1.4;

/// A start point of a cause, and the mean square that a scan predicts for it.
struct Judged {
  double mean_square_mm2 = 0;
  const Scan* place = nullptr;
  const model::BlockSpec* block = nullptr;
  const CauseForm* form = nullptr;
};

}  // namespace

Scan::Scan(const std::vector<Record>& records, const std::vector<Cause>& causes, FitPoint place)
    : records_(records), place_(std::move(place)), space_(structure_space(records_, place_.model, causes)) {
  const auto residuals = residuals_for(records_, space_);
  const auto rows = static_cast<Eigen::Index>(residuals->count());
  const auto columns = static_cast<Eigen::Index>(space_.size());
  Jacobian jacobian(rows, columns);
  residual_.resize(rows);
  usable_ = residuals->evaluate(space_.z(place_), {residual_.data(), residuals->count()},
                                {jacobian.data(), residuals->count() * space_.size()});
  if (!usable_) return;
  jacobian_ = jacobian;
  Eigen::MatrixXd normal = jacobian_.transpose() * jacobian_;
  normal.diagonal() *= 1 + step_damping;
  normal.diagonal().array() += 1e-12;
  normal_.compute(normal);
  left_ = left_of(residual_);
}

Eigen::MatrixXd Scan::left_of(const Eigen::MatrixXd& columns) const {
  return columns - jacobian_ * normal_.solve(jacobian_.transpose() * columns);
}

FitPoint Scan::answer_to(const Eigen::VectorXd& residual, double share) const {
  const Eigen::VectorXd step = -normal_.solve(jacobian_.transpose() * residual);
  std::vector<double> z = space_.z(place_);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const FreeParameter& free = space_.free()[i];
    z[i] = std::clamp(z[i] + share * step(static_cast<Eigen::Index>(i)), free.lower_z(), free.upper_z());
  }
  return space_.point(z);
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
                                  std::size_t fewest) {
  const std::vector<model::BlockSpec> starts = starts_of(cause, scales);
  std::vector<Judged> judged;
  for (const Scan& scan : scans) {
    for (const model::BlockSpec& start : starts) {
      const CauseForm& form = form_of(cause, start);
      if (form.free_form) continue;
      const double square = scan.mean_square_with(start);
      if (std::isfinite(square)) judged.push_back({square, &scan, &start, &form});
    }
  }
  std::stable_sort(judged.begin(), judged.end(),
                   [](const Judged& a, const Judged& b) { return a.mean_square_mm2 < b.mean_square_mm2; });
  std::set<const CauseForm*> forms;
  std::set<const Scan*> places;
  std::vector<Judged> chosen, others;
  for (const Judged& one : judged) {
    const bool new_form = forms.insert(one.form).second;
    const bool new_place = places.insert(one.place).second;
    (new_form || new_place ? chosen : others).push_back(one);
  }
  for (std::size_t i = 0; i < others.size() && chosen.size() < fewest; ++i) chosen.push_back(others[i]);
  for (const model::BlockSpec& start : starts) {
    const CauseForm& form = form_of(cause, start);
    if (form.free_form && !scans.empty() && scans.front().usable())
      chosen.push_back({0, &scans.front(), &start, &form});
  }
  std::vector<FitPoint> points;
  for (const Judged& one : chosen) {
    points.push_back(one.place->place());
    points.back().model = model::with_block(points.back().model, *one.block);
  }
  return points;
}

}  // namespace softgrip::sysid
