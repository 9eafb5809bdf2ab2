// Computes the residuals of a separable chain, and converts the columns of the chain to derivatives with
// respect to the parameters of the fit.

#include <cmath>

#include "sysid/fitting/residuals.h"
#include "sysid/fitting/separable.h"
#include "sysid/logs/each_record.h"

namespace softgrip::sysid {
namespace {

/// Smallest number of samples per thread. For fewer samples, the simulation takes less time than the start of
/// a thread.
constexpr std::size_t samples_worth_one = 4 * samples_worth_a_thread;

/// Returns a matrix M that converts the columns of the chain to derivatives with respect to the fit
/// parameters. A row of the Jacobian is a row of the full columns of the record, multiplied by M.
Eigen::MatrixXd mapping(const SeparableShape& shape, const SeparableColumns& c, const FitSpace& space,
                        const FitPoint& point, std::span<const double> z, std::size_t record) {
  const auto& blocks = point.model.blocks;
  const std::vector<double>& kv = blocks[shape.kelvin_voigt].values;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(c.all(), static_cast<Eigen::Index>(space.size()));
  for (std::size_t i = 0; i < space.size(); ++i) {
    const FreeParameter& p = space.free()[i];
    auto column = m.col(static_cast<Eigen::Index>(i));
    const double slope = p.slope(z[i]);
    if (p.kind != FreeParameter::Kind::model) {
      if (p.record != record) continue;
      if (p.kind == FreeParameter::Kind::offset) column(c.offset()) = slope;
      if (p.kind == FreeParameter::Kind::peak_before) column(c.peak()) = slope;
      if (p.kind == FreeParameter::Kind::unsettled) column(c.unsettled(p.branch)) = slope;
      continue;
    }
    const model::ParameterPlace place = model::place_of(point.model, p.flat_index);
    if (shape.delay && place.block == *shape.delay) column(c.delay()) = slope;
    if (shape.lag && place.block == *shape.lag) column(c.lag()) = slope;
    if (place.block == shape.bouc_wen) {
      if (place.value == 0) column(SeparableColumns::pressure()) = slope;
      if (place.value == 1) column(SeparableColumns::hysteresis()) = slope;
      if (place.value == 2 || place.value == 3) {
        column(c.growing()) = slope;
        column(c.shrinking()) = place.value == 2 ? slope : -slope;
      }
    }
    if (place.block != shape.kelvin_voigt) continue;
    if (place.value == 0) {
      column(SeparableColumns::pressure()) = -slope / (kv[0] * kv[0]);
      continue;
    }
    const std::size_t b = (place.value - 1) / 2;
    const double k = kv[1 + 2 * b];
    const double damping = kv[2 + 2 * b];
    const bool by_stiffness = (place.value - 1) % 2 == 0;
    column(c.rate(b)) = slope * (by_stiffness ? 1 / damping : -k / (damping * damping));
    if (!by_stiffness) column(c.branch(b)) = -slope / (damping * damping);
  }
  return m;
}

/// Copies blocks of rows to the residuals and the Jacobian.
class Writer final : public SeparableRecord::Sink {
 public:
  Writer(const Eigen::MatrixXd& map, double* r, double* jacobian) : map_(map), r_(r), jacobian_(jacobian) {}

  void block(const Eigen::Ref<const Eigen::MatrixXd>& rows) override {
    if (r_ != nullptr) {
      Eigen::Map<Eigen::VectorXd>(r_, rows.rows()) = rows.col(rows.cols() - 1);
      r_ += rows.rows();
    }
    if (jacobian_ != nullptr) {
      Eigen::Map<Jacobian>(jacobian_, rows.rows(), map_.cols()).noalias() =
          rows.leftCols(rows.cols() - 1) * map_;
      jacobian_ += rows.rows() * map_.cols();
    }
  }

 private:
  const Eigen::MatrixXd& map_;
  double* r_;
  double* jacobian_;
};

class SeparableResiduals final : public Residuals {
 public:
  SeparableResiduals(const std::vector<Record>& records, FitSpace space, const SeparableShape& shape)
      : Residuals(records, std::move(space)), shape_(shape), first_row_(first_rows_of(records)) {
    for (const Record& record : records) prepared_.emplace_back(record, shape);
  }

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    const FitPoint point = space_.point(z);
    const SeparablePoint separable = to_separable(shape_, point);
    if (separable.growing_per_kpa < 0) return false;
    const auto walk = [&](std::size_t k) {
      const std::size_t row = first_row_[k];
      const Eigen::MatrixXd map = mapping(shape_, prepared_[k].columns(), space_, point, z, k);
      Writer writer(map, r.empty() ? nullptr : &r[row],
                    jacobian.empty() ? nullptr : &jacobian[row * space_.size()]);
      prepared_[k].full(separable, k, writer);
    };
    for_each_record(records_, walk, samples_worth_one);
    double sum = 0;
    for (const double value : r) sum += value;
    for (const double value : jacobian) sum += value;
    return std::isfinite(sum);
  }

 private:
  SeparableShape shape_;
  std::vector<SeparableRecord> prepared_;
  std::vector<std::size_t> first_row_;  ///< index of the first row of each record
};

}  // namespace

Residuals::Residuals(const std::vector<Record>& records, FitSpace space)
    : records_(records), space_(std::move(space)), count_(reading_count(records)) {}

std::unique_ptr<Residuals> separable_residuals(const std::vector<Record>& records, FitSpace space) {
  const std::vector<double> middle(space.size(), 0.0);
  const auto shape = separable_shape(space.point(middle).model);
  if (!shape) return nullptr;
  return std::make_unique<SeparableResiduals>(records, std::move(space), *shape);
}

std::unique_ptr<Residuals> residuals_for(const std::vector<Record>& records, const FitSpace& space) {
  auto separable = separable_residuals(records, space);
  return separable ? std::move(separable) : chain_residuals(records, space);
}

}  // namespace softgrip::sysid
