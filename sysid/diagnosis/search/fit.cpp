#include "sysid/diagnosis/search/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/each_record.h"

namespace softgrip::sysid {
namespace {

bool moves(const model::Model& model, const std::vector<Cause>& causes, std::size_t flat_index) {
  const model::ParameterPlace place = model::place_of(model, flat_index);
  const CauseForm* form = form_among(causes, model.blocks[place.block]);
  return is_movable(model, flat_index) && (form == nullptr || form->is_fitted(place.value));
}

void bound_by_forms(FitSpace& space, const std::vector<Record>& records, const model::Model& model,
                    const std::vector<Cause>& causes) {
  const Scales scales = scales_of(records);
  for (std::size_t i = 0; i < space.size(); ++i) {
    const FreeParameter& free = space.free()[i];
    if (free.kind != FreeParameter::Kind::model) continue;
    const model::ParameterPlace place = model::place_of(model, free.flat_index);
    if (const CauseForm* form = form_among(causes, model.blocks[place.block])) {
      const Range range = form->range(place.value, scales, model);
      space.bound(i, range.lower, range.upper);
    }
  }
}

}  // namespace

std::vector<std::size_t> fitted_indices(const model::Model& model, const std::vector<Cause>& causes) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < model::parameter_count(model); ++i) {
    if (moves(model, causes, i)) indices.push_back(i);
  }
  return indices;
}

FitSpace structure_space(const std::vector<Record>& records, const model::Model& model,
                         const std::vector<Cause>& causes) {
  FitSpace space(model, records, fitted_indices(model, causes));
  bound_by_forms(space, records, model, causes);
  return space;
}

FitSpace cause_space(const std::vector<Record>& records, const FitPoint& point, const Cause& cause) {
  std::vector<std::size_t> indices = fitted_indices(point.model, {cause});
  const std::size_t own = *position_of(point.model, cause);
  std::erase_if(indices, [&](std::size_t i) { return model::place_of(point.model, i).block != own; });
  FitSpace space(point.model, records, indices);
  space.hold_starts(point.starts);
  bound_by_forms(space, records, point.model, {cause});
  return space;
}

StructureFit evaluate_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                                const FitPoint& point) {
  StructureFit fit;
  fit.causes = std::move(causes);
  fit.point = point;
  fit.residual_mm.resize(records.size());
  for_each_record(records, [&](std::size_t k) {
    fit.residual_mm[k] = residual(records[k], predict(point.model, records[k], point.starts[k]));
  });
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); ++i) {
      if (std::isnan(records[k].reading_mm[i])) continue;
      sum += fit.residual_mm[k][i] * fit.residual_mm[k][i];
      ++count;
    }
  }
  fit.mean_square_mm2 = count == 0 || !std::isfinite(sum) ? std::numeric_limits<double>::infinity()
                                                          : sum / static_cast<double>(count);
  return fit;
}

StructureFit fit_structure(const std::vector<Record>& records, std::vector<Cause> causes,
                           const FitPoint& from, const FitEffort& effort) {
  FitSpace space = structure_space(records, from.model, causes);
  if (effort.hold_starts) space.hold_starts(from.starts);
  const auto residuals = residuals_for(records, space);
  MinimiseOptions options;
  options.most_iterations = effort.most_iterations;
  options.tolerance =
      std::max(effort.tolerance, limits::negligible_share / static_cast<double>(residuals->count()));
  const Minimum minimum = minimise(*residuals, space.z(from), options);
  StructureFit fit = evaluate_structure(records, std::move(causes), space.point(minimum.z));
  fit.free_parameters = space.size();
  return fit;
}

StructureFit fit_starts(const std::vector<Record>& records, std::vector<Cause> causes,
                        const FitPoint& point) {
  const FitSpace space(point.model, records, {});
  if (space.size() == 0) return evaluate_structure(records, std::move(causes), space.point({}));
  const auto residuals = residuals_for(records, space);
  return evaluate_structure(records, std::move(causes), space.point(minimise(*residuals, space.z(point)).z));
}

std::vector<Record> without_effects(std::vector<Record> records, const FitPoint& point,
                                    const std::vector<Cause>& causes) {
  model::Model bare = point.model;
  for (const Cause& cause : causes) bare = without(std::move(bare), cause);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const std::vector<double> with = predict(point.model, records[k], point.starts[k]);
    const std::vector<double> rest = predict(bare, records[k], point.starts[k]);
    for (std::size_t i = 0; i < with.size(); ++i) records[k].reading_mm[i] -= with[i] - rest[i];
  }
  return records;
}

StructureFit without_cause(StructureFit fit, const Cause& cause) {
  std::erase(fit.causes, cause);
  fit.point.model = without(std::move(fit.point.model), cause);
  return fit;
}

StructureFit fit_without_cause(const std::vector<Record>& records, const StructureFit& fit,
                               const Cause& cause, const FitEffort& effort) {
  StructureFit rest = without_cause(fit, cause);
  return fit_structure(records, std::move(rest.causes), rest.point, effort);
}

}  // namespace softgrip::sysid
