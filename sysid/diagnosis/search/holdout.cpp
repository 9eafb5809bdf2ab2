#include "sysid/diagnosis/search/holdout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "sysid/fitting/residuals.h"
#include "sysid/fitting/start_estimate.h"

namespace softgrip::sysid {
namespace {

/// Effort of the refits. The initial states of the logs stay fixed. Otherwise, the initial state of a log
/// would be undetermined if the first block of the log is held out. The simulation of all later blocks would
/// then start at an arbitrary state.
constexpr FitEffort refit{.most_iterations = 8, .tolerance = 1e-6, .hold_starts = true};

/// Ranges of Jacobian rows that belong to a block. The rows `first` to `last` are the readings in the block.
/// The rows `hidden_first` to `hidden_last` are the readings that are excluded from the fit. The excluded
/// readings include some readings near the block.
struct BlockRows {
  Eigen::Index first, last, hidden_first, hidden_last;
};

std::vector<BlockRows> rows_of(const std::vector<Record>& records, const Division& division) {
  // For each sample, the number of readings in all earlier samples and records.
  std::vector<std::vector<Eigen::Index>> before(records.size());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    before[k].reserve(records[k].size() + 1);
    for (const double y : records[k].reading_mm) {
      before[k].push_back(row);
      if (std::isfinite(y)) ++row;
    }
    before[k].push_back(row);
  }
  std::vector<BlockRows> rows;
  for (const Block& block : division.blocks) {
    const std::vector<Eigen::Index>& at = before[block.record];
    rows.push_back({at[block.first], at[block.last], at[block.hidden_first], at[block.hidden_last]});
  }
  return rows;
}

}  // namespace

BlockLosses losses_of(const StructureFit& fit, const Division& division) {
  BlockLosses losses;
  for (const Block& block : division.blocks) losses.push_back(loss_of(fit.residual_mm[block.record], block));
  return losses;
}

BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                            const StructureFit& fit) {
  return held_out_losses(records, division, [&](const std::vector<Record>& rest) {
    return fit_structure(rest, fit.causes, fit.point, refit).point;
  });
}

BlockLosses left_out_losses(const std::vector<Record>& records, const Division& by_unit,
                            const StructureFit& fit) {
  return held_out_losses(records, by_unit, [&](const std::vector<Record>& rest) {
    // No fit is possible if all readings belong to the cross-validation unit that is left out.
    const bool is_fitted =
        std::any_of(rest.begin(), rest.end(), [](const Record& r) { return r.readings > 0; });
    FitPoint point = is_fitted ? fit_structure(rest, fit.causes, fit.point, refit).point : fit.point;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      if (rest[k].readings == 0) point.starts[k] = estimated_start(point.model, records[k]);
    }
    return point;
  });
}

BlockLosses linear_held_out_losses(const std::vector<Record>& records, const Division& division,
                                   const StructureFit& fit) {
  FitSpace space = structure_space(records, fit.point.model, fit.causes);
  space.hold_starts(fit.point.starts);
  const auto residuals = residuals_for(records, space);
  const auto count = static_cast<Eigen::Index>(residuals->count());
  const auto numbers = static_cast<Eigen::Index>(space.size());
  Eigen::VectorXd r(count);
  Jacobian jacobian(count, numbers);
  BlockLosses losses(division.blocks.size(), std::numeric_limits<double>::infinity());
  if (!residuals->evaluate(space.z(fit.point), {r.data(), residuals->count()},
                           {jacobian.data(), residuals->count() * space.size()})) {
    return losses;
  }
  const std::vector<BlockRows> rows = rows_of(records, division);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(numbers, numbers);
  whole.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose());
  const Eigen::VectorXd gradient = jacobian.transpose() * r;
  for (std::size_t fold = 0; fold < division.folds; ++fold) {
    Eigen::MatrixXd normal = whole;
    Eigen::VectorXd right = gradient;
    // end of the rows that were already removed; the excluded rows of two blocks may overlap
    Eigen::Index done = 0;
    for (std::size_t b = 0; b < rows.size(); ++b) {
      if (division.blocks[b].fold != fold) continue;
      const Eigen::Index from = std::max(rows[b].hidden_first, done), length = rows[b].hidden_last - from;
      done = rows[b].hidden_last;
      if (length <= 0) continue;
      const auto part = jacobian.middleRows(from, length);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose(), -1);
      right -= part.transpose() * r.segment(from, length);
    }
    normal.diagonal() += step_damping * whole.diagonal() + Eigen::VectorXd::Constant(numbers, 1e-12);
    const Eigen::VectorXd step = -normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    for (std::size_t b = 0; b < rows.size(); ++b) {
      if (division.blocks[b].fold != fold) continue;
      const Eigen::Index length = rows[b].last - rows[b].first;
      const Eigen::VectorXd held =
          r.segment(rows[b].first, length) + jacobian.middleRows(rows[b].first, length) * step;
      losses[b] = length > 0 ? held.squaredNorm() / static_cast<double>(length) : 0;
    }
  }
  return losses;
}

}  // namespace softgrip::sysid
