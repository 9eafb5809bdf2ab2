#include "sysid/diagnosis/verdict/base_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "base/parallel.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_dependent_creep.h"
#include "model/blocks/transport_delay.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/hysteresis_shape.h"
#include "sysid/diagnosis/causes/sensor_lag.h"
#include "sysid/diagnosis/causes/sensor_nonlinearity.h"
#include "sysid/diagnosis/causes/slow_creep.h"
#include "sysid/diagnosis/causes/stiffening.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_lag.h"
#include "sysid/fitting/residuals.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/uncertainty.h"
#include "sysid/structure/held_out_blocks.h"
#include "sysid/structure/structure_choice.h"
#include "sysid/structure/structure_model.h"

namespace softgrip::sysid {
namespace {

/// A richer base must leave less than this share of the error that was reached without it, in what comes
/// after what was fitted.
constexpr double worth_having = 0.9;
/// Named alone at this inclusion and above.
constexpr double full_inclusion = 0.95;
/// What an ingredient must bring of the mean square that the recalibrated base left beyond the noise.
constexpr double least_share = 0.01;

/// What a finding is called, and with which blocks it stands in the model.
struct FindingName {
  Ingredient ingredient;
  std::string_view id;
  std::string_view rival;  ///< gives the same readings whatever the command; empty: none
  std::size_t (*block)(Drive drive);
};
constexpr std::array names{
    FindingName{Ingredient::play_operators, causes::HysteresisShape::id, "",
                [](Drive) { return model::block_type<model::PrandtlIshlinskii>(); }},
    FindingName{Ingredient::slow_creep, causes::SlowCreep::id, "",
                [](Drive) { return model::block_type<model::KelvinVoigt>(); }},
    FindingName{Ingredient::pressure_dependent_creep, causes::SlowCreep::id, "",
                [](Drive) { return model::block_type<model::PressureDependentCreep>(); }},
    FindingName{Ingredient::delay, causes::TransportDelay::id, "",
                [](Drive) { return model::block_type<model::TransportDelay>(); }},
    FindingName{Ingredient::lag, causes::ValveLag::id, "",
                [](Drive drive) {
                  return drive == Drive::measured ? model::block_type<model::ChamberLag>()
                                                  : model::block_type<model::AsymmetricValveLag>();
                }},
    FindingName{Ingredient::characteristic, causes::Stiffening::id, causes::SensorNonlinearity::id,
                [](Drive) { return model::block_type<model::Characteristic>(); }}};

BlockLosses recalibrated_losses(const std::vector<Record>& records, const StructureFit& fit,
                                unsigned threads) {
  const HeldOutBlocks blocks(records);
  BlockLosses losses(blocks.count(), 0);
  parallel_for(HeldOutBlocks::folds, threads, [&](std::size_t fold) {
    blocks.judge(fit_structure(blocks.without(fold), {}, fit.point).point, fold, losses);
  });
  return losses;
}

/// Whether the richer base foretells the second halves of the logs from the first clearly better than what
/// was reached.
bool foretells_better(const SearchData& data, const StructureTrial& chosen, const StructureFit& reached,
                      Drive drive) {
  const HeldOutContinuation halves(data.records);
  const double before_mm =
      rmse_mm(halves.judge(fit_structure(halves.first_half(), reached.causes, reached.point).point));
  const double with_mm = rmse_mm(halves.judge(fit_again(chosen, halves.first_half(), drive)));
  return with_mm < worth_having * before_mm;
}

/// A model that moves the wrong way first is none of a finger, however well it follows one: any richer base
/// that fits as well stands before it.
bool stands_before(const StructureTrial& chosen, const StructureFit& reached) {
  return !chosen.structure.published && beta_over_gain(reached.point.model) > 1 &&
         chosen.rmse_mm * chosen.rmse_mm < reached.mean_square_mm2;
}

class Namer {
 public:
  Namer(const SearchData& data, const StructureTrial& chosen, const BaseQuestion& question)
      : chosen_(chosen),
        question_(question),
        residuals_(residuals_for(data.records, fitted_space(chosen.point, data.records))),
        z_(residuals_->space().z(chosen.point)),
        uncertainty_(uncertainty_at(*residuals_, z_, std::numeric_limits<double>::infinity())) {}

  [[nodiscard]] NamedCause name(const FindingName& finding, const StructureTrial& without) const {
    NamedCause named;
    named.cause = *find_cause(finding.id);
    named.block_type = finding.block(question_.drive);
    if (!finding.rival.empty()) named.rivals.push_back(*find_cause(finding.rival));
    // Between the point where the pressure is measured and the reading it may be either.
    if (finding.ingredient == Ingredient::lag && question_.drive == Drive::measured)
      named.rivals.push_back(*find_cause(causes::SensorLag::id));
    named.heldout_gain_percent =
        gain_percent(without.block_losses_mm2, chosen_.block_losses_mm2, question_.seed);
    named.gain_mm2 = mean_difference(without.block_losses_mm2, chosen_.block_losses_mm2, question_.seed);
    named.inclusion = winning_share(chosen_.block_losses_mm2, without.block_losses_mm2, question_.seed);
    named.parameters = parameters(named.block_type);
    return named;
  }

 private:
  [[nodiscard]] std::vector<CauseParameter> parameters(std::size_t type) const {
    std::vector<CauseParameter> list;
    const model::Model& model = chosen_.point.model;
    const auto position = model::position_of(model, type);
    if (!position) return list;
    const model::BlockSpec& block = model.blocks[*position];
    for (std::size_t i = 0; i < block.values.size(); ++i) {
      const FitSpace& space = residuals_->space();
      CauseParameter p;
      p.name = model::parameter_name(block, i);
      p.unit = std::string(model::catalogue()[type].spec(i).unit);
      p.value = block.values[i];
      for (std::size_t j = 0; j < space.size(); ++j) {
        const FreeParameter& free = space.free()[j];
        if (free.kind != FreeParameter::Kind::model) continue;
        const model::ParameterPlace place = model::place_of(model, free.flat_index);
        if (place.block != *position || place.value != i || uncertainty_.at_bound[j]) continue;
        const auto at = static_cast<Eigen::Index>(j);
        const double half = uncertainty_.quantile * std::sqrt(std::max(0.0, uncertainty_.covariance(at, at)));
        if (half == 0) continue;
        p.ci95 = {std::max(free.to_value(z_[j] - half), free.lower),
                  std::min(free.to_value(z_[j] + half), free.upper)};
        p.has_interval = true;
      }
      list.push_back(std::move(p));
    }
    return list;
  }

  const StructureTrial& chosen_;
  const BaseQuestion& question_;
  std::unique_ptr<Residuals> residuals_;
  std::vector<double> z_;
  Uncertainty uncertainty_;
};

}  // namespace

std::optional<BaseFindings> find_base(const SearchData& data, const StructureFit& recalibrated,
                                      const StructureFit& reached, const BaseQuestion& question) {
  StructureChoiceOptions options;
  options.drive = question.drive;
  options.seed = question.seed;
  options.threads = question.threads;
  options.progress = question.progress;
  const StructureChoice choice = choose_structure(data.records, options);
  const StructureTrial& chosen = choice.trials[choice.chosen];
  BaseFindings found;
  found.losses = chosen.block_losses_mm2;
  if (!stands_before(chosen, reached) && !foretells_better(data, chosen, reached, question.drive))
    return std::nullopt;
  found.fit = evaluate_structure(data.records, {}, chosen.point);
  found.description = description_of(chosen.structure);
  found.recalibrated_losses = recalibrated_losses(data.records, recalibrated, question.threads);
  const double excess_mm2 = std::max(
      std::pow(rmse_mm(found.recalibrated_losses), 2) - question.noise_mm * question.noise_mm, 1e-300);
  const Namer namer(data, chosen, question);
  for (const FindingName& finding : names) {
    const auto without = std::find_if(choice.ablation.begin(), choice.ablation.end(),
                                      [&](const auto& w) { return w.ingredient == finding.ingredient; });
    if (without == choice.ablation.end()) continue;
    NamedCause named = namer.name(finding, without->trial);
    if (named.gain_mm2.value < least_share * excess_mm2) continue;
    const auto same = [&](const NamedCause& other) { return other.cause == named.cause; };
    if (std::any_of(found.named.begin(), found.named.end(), same)) continue;
    (named.inclusion >= full_inclusion ? found.named : found.possible).push_back(std::move(named));
  }
  return found;
}

}  // namespace softgrip::sysid
