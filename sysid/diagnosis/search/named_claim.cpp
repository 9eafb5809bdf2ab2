#include "sysid/diagnosis/search/named_claim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "model/catalogue.h"
#include "sysid/evidence/comparison.h"
#include "sysid/evidence/signature.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void claim_size(Claim& claim, const std::vector<Record>& records, const Cause& cause,
                const StructureFit& with) {
  const model::Model& model = with.point.model;
  const FitSpace space = structure_space(records, model, with.causes);
  const auto residuals = residuals_for(records, space);
  const std::vector<double> z = space.z(with.point);
  const auto size =
      size_of(model, *position_of(model, cause), space, z, uncertainty_at(*residuals, z, infinity));
  if (!size) return;
  claim.size = size->interval;
  claim.largest_size = largest_possible_size(campaign_size(records), size->unit, size->neutral);
}

/// Returns one value per reading, in the order of the records: true if the cause must have an effect on the
/// reading.
std::vector<bool> required_readings(const std::vector<Record>& records, Appears appears,
                                    const StructureFit& without) {
  std::vector<OperatingPoint> conditions;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    const std::vector<double> rates = rates_of(record);
    const std::vector<double> motion = predict(without.point.model, record, without.point.starts[r]);
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (std::isfinite(record.reading_mm[i]))
        conditions.push_back({record.drive_kpa[i], rates[i], motion[i]});
    }
  }
  return required_at(appears, conditions);
}

/// Returns the sums of squared residuals with and without the cause, for each block. The sums include only
/// readings on which the cause must have an effect.
PairedLosses losses_there(const std::vector<Record>& records, const std::vector<bool>& required,
                          const StructureFit& with, const StructureFit& without) {
  PairedLosses losses;
  std::vector<std::size_t> before{0};  // for each record, number of readings in all earlier records
  for (const Record& record : records) before.push_back(before.back() + record.readings);
  std::vector<std::size_t> next = before;
  for (const Block& block : divide(records, limits::block_in_units * time_unit_s(records)).blocks) {
    losses.begin_block();
    for (std::size_t i = block.first; i < block.last; ++i) {
      if (!std::isfinite(records[block.record].reading_mm[i]) || !required[next[block.record]++]) continue;
      losses.add(without.residual_mm[block.record][i], with.residual_mm[block.record][i]);
    }
  }
  return losses;
}

}  // namespace

std::optional<BlockSize> size_of(const model::Model& model, std::size_t position, const FitSpace& space,
                                 std::span<const double> z, const Uncertainty& uncertainty) {
  std::optional<BlockSize> size;
  double farthest = -infinity;
  for (std::size_t j = 0; j < space.size(); ++j) {
    const FreeParameter& free = space.free()[j];
    if (free.kind != FreeParameter::Kind::model || uncertainty.at_bound[j]) continue;
    const model::ParameterPlace place = model::place_of(model, free.flat_index);
    if (place.block != position) continue;
    const model::ParameterSpec& spec = model::catalogue()[model.blocks[position].type].spec(place.value);
    const double deviation = uncertainty.deviation(j);
    if (!std::isfinite(spec.neutral) || !(deviation > 0)) continue;
    const double half = uncertainty.quantile * deviation;
    const double distance = std::abs(z[j] - free.to_z(spec.neutral)) / deviation;
    if (!(distance > farthest)) continue;
    farthest = distance;
    size = {{free.to_value(z[j] - half) - spec.neutral, free.to_value(z[j] + half) - spec.neutral},
            spec.neutral,
            spec.unit};
  }
  return size;
}

Veto veto_of(const std::vector<Record>& records, const Cause& cause, const StructureFit& with,
             const StructureFit& without, const LeftOutLosses& left_out, std::uint64_t seed) {
  Claim claim;
  const std::vector<bool> required = required_readings(records, cause.appears, without);
  claim.condition_met = is_met(required);
  if (!claim.condition_met) return veto_of(claim);
  const bool is_free = has_free_form(with.point.model, cause);
  if (!is_free) claim_size(claim, records, cause, with);
  claim.error_without = std::sqrt(without.mean_square_mm2);
  claim.error_with = std::sqrt(with.mean_square_mm2);
  claim.shown_there = is_better(compare(losses_there(records, required, with, without), 0, seed));
  if (const Veto veto = veto_of(claim); veto != Veto::none || is_free) return veto;
  claim.predicts_worse = !(rmse_mm(left_out(with)) < rmse_mm(left_out(without)));
  return veto_of(claim);
}

bool put_nameable_first(std::vector<ScoredCandidate>& scored, const std::vector<Record>& records,
                        const StructureFit& without, const std::function<bool(const ScoredCandidate&)>& gains,
                        const LeftOutLosses& left_out, std::uint64_t seed) {
  std::optional<BlockLosses> losses_without;  // losses of the structure without the cause, which are the same
                                              // for all candidates
  const LeftOutLosses once = [&](const StructureFit& fit) {
    if (&fit != &without) return left_out(fit);
    if (!losses_without) losses_without = left_out(without);
    return *losses_without;
  };
  for (auto best = scored.begin(); best != scored.end() && gains(*best); ++best) {
    if (best != scored.begin() && !ties(scored.front(), *best, seed)) break;
    const Veto veto = veto_of(records, best->candidate.cause, *best->candidate.fit, without, once, seed);
    if (veto == Veto::none) {
      std::rotate(scored.begin(), best, best + 1);
      return true;
    }
    best->candidate.why_not = reason_of(veto);
  }
  return false;
}

}  // namespace softgrip::sysid
