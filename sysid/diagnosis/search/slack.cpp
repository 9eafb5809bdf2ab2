#include "sysid/diagnosis/search/slack.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "model/blocks/backlash.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/named.h"

namespace softgrip::sysid {
namespace {

struct Operator {
  double threshold_kpa, weight_mm_per_kpa;
};

/// Returns the play operators of the model in the order of increasing thresholds. Returns an empty list if
/// the model contains no play operators.
std::vector<Operator> operators_of(const model::Model& model) {
  std::vector<Operator> operators;
  const model::BlockSpec* const plays = model::find_block<model::PrandtlIshlinskii>(model);
  if (plays == nullptr) return operators;
  for (std::size_t i = model::parameter_index<model::PrandtlIshlinskii>("r1_kpa"); i < plays->values.size();
       i += 2)
    operators.push_back({plays->values[i], plays->values[i + 1]});
  return operators;
}

}  // namespace

double elastic_share(const model::Model& model) {
  double at_once = 0, sum = 0;
  for (const Operator& each : operators_of(model)) {
    if (each.threshold_kpa == 0) at_once += each.weight_mm_per_kpa;
    sum += each.weight_mm_per_kpa;
  }
  return sum > 0 ? at_once / sum : 1;
}

std::optional<model::Model> with_slack_as_backlash(const model::Model& model) {
  if (model::position_of<model::Backlash>(model)) return std::nullopt;
  double play_kpa = 0, gap_mm = 0;
  std::vector<Operator> sooner{{0, 0}};
  for (const Operator& each : operators_of(model)) {
    if (each.threshold_kpa > 0 && play_kpa == 0) {
      play_kpa = each.threshold_kpa;
      gap_mm = 2 * play_kpa * each.weight_mm_per_kpa;
    }
    if (each.threshold_kpa <= play_kpa) {
      sooner.front().weight_mm_per_kpa += each.weight_mm_per_kpa;
    } else {
      sooner.push_back({each.threshold_kpa - play_kpa, each.weight_mm_per_kpa});
    }
  }
  if (!(gap_mm > 0)) return std::nullopt;
  model::Model shifted = model;
  std::vector<double>& values = shifted.blocks[*model::position_of<model::PrandtlIshlinskii>(model)].values;
  values.resize(model::parameter_index<model::PrandtlIshlinskii>("r1_kpa"));
  for (const Operator& each : sooner)
    values.insert(values.end(), {each.threshold_kpa, each.weight_mm_per_kpa});
  return model::with_block(std::move(shifted), model::block_of<model::Backlash>({{"gap_mm", gap_mm}}));
}

}  // namespace softgrip::sysid
