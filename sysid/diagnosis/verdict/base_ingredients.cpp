#include "sysid/diagnosis/verdict/base_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_dependent_creep.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/transport_delay.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "model/registry.h"
#include "sysid/diagnosis/causes/backlash.h"
#include "sysid/diagnosis/causes/hysteresis_shape.h"
#include "sysid/diagnosis/causes/sensor_lag.h"
#include "sysid/diagnosis/causes/sensor_nonlinearity.h"
#include "sysid/diagnosis/causes/slow_creep.h"
#include "sysid/diagnosis/causes/stiffening.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_deadband.h"
#include "sysid/diagnosis/causes/valve_lag.h"
#include "sysid/diagnosis/search/named_claim.h"
#include "sysid/diagnosis/search/slack.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/limits/limits.h"
#include "sysid/structure/published_element.h"

namespace softgrip::sysid {
namespace {

/// Ratio of the held-out RMSE to the unexplained error of the fit above which a fold counts as diverged.
constexpr double ran_off_above = 3;

/// Elastic share of play operators below which they act like a backlash. The elastic share is the part of the
/// motion that follows a reversal of the pressure at once. It is between 0.09 and 0.81 in 20 textbook
/// fingers. With a hidden backlash whose effect is 8 times the noise, it is between 0.01 and 0.15.
constexpr double stands_still_below = 0.07;

/// Cause as which a component of the structure is reported, and type of the block that contains the component
/// in the model.
struct FindingName {
  Ingredient ingredient;
  std::string_view id;
  /// Id of a cause with the same readings for every command; empty: there is no such cause.
  std::string_view alternative;
  std::size_t (*block)(const BaseStructure& structure, Drive drive);
};
constexpr std::array names{
    FindingName{Ingredient::play_operators, causes::HysteresisShape::id, "",
                [](const BaseStructure&, Drive) { return model::block_type<model::PrandtlIshlinskii>(); }},
    FindingName{Ingredient::slow_creep, causes::SlowCreep::id, "",
                [](const BaseStructure&, Drive) { return model::block_type<model::KelvinVoigt>(); }},
    FindingName{
        Ingredient::pressure_dependent_creep, causes::SlowCreep::id, "",
        [](const BaseStructure&, Drive) { return model::block_type<model::PressureDependentCreep>(); }},
    FindingName{Ingredient::delay, causes::TransportDelay::id, "",
                [](const BaseStructure&, Drive) { return model::block_type<model::TransportDelay>(); }},
    FindingName{Ingredient::lag, causes::ValveLag::id, "",
                [](const BaseStructure& structure, Drive drive) {
                  return drive == Drive::measured ? model::block_type<model::ChamberLag>()
                         : structure.regulator    ? model::block_type<model::PressureRegulator>()
                                                  : model::block_type<model::AsymmetricValveLag>();
                }},
    FindingName{Ingredient::regulator, causes::ValveDeadband::id, "",
                [](const BaseStructure&, Drive) { return model::block_type<model::PressureRegulator>(); }},
    FindingName{Ingredient::characteristic, causes::Stiffening::id, causes::SensorNonlinearity::id,
                [](const BaseStructure&, Drive) { return model::block_type<model::Characteristic>(); }}};

/// Returns the held-out mean square of the refitted given model minus the noise variance [mm^2]. The result
/// has an upper limit: if a fold diverges, its error does not show how large the unexplained error is.
double left_by_the_given_mm2(const BaseSearch& search) {
  const double noise_mm = search.question.noise_mm;
  const double held_out_mm2 = std::pow(rmse_mm(search.plain.base_losses), 2) - noise_mm * noise_mm;
  const double most_mm2 = std::pow(ran_off_above * search.plain.base_unexplained.excess_mm, 2);
  return std::max(std::min(held_out_mm2, most_mm2), 1e-300);
}

const StructureTrial* trial_without(const std::vector<WithoutIngredient>& ablation, Ingredient ingredient) {
  const auto found = std::find_if(ablation.begin(), ablation.end(),
                                  [&](const auto& without) { return without.ingredient == ingredient; });
  return found == ablation.end() ? nullptr : &found->trial;
}

class Labeller {
 public:
  /// @param point  parameters of the chosen structure after a fit to all readings.
  Labeller(const SearchData& data, const StructureTrial& chosen, const FitPoint& point,
           const BaseQuestion& question)
      : chosen_(chosen),
        question_(question),
        stands_still_(elastic_share(chosen.point.model) < stands_still_below),
        space_(point.model, data.records, free_numbers(point.model)),
        at_(uncertain_point(data.records, point, space_)) {}

  [[nodiscard]] NamedCause name(const FindingName& finding, const StructureTrial& without) const {
    NamedCause named{chosen_cause(*find_cause(finding.id), without.block_losses_mm2, chosen_.block_losses_mm2,
                                  question_.seed),
                     finding.block(chosen_.structure, question_.drive),
                     {},
                     {}};
    if (!finding.alternative.empty()) named.alternatives.push_back(*find_cause(finding.alternative));
    if (finding.ingredient == Ingredient::play_operators && stands_still_)
      named.alternatives.push_back(*find_cause(causes::Backlash::id));
    // The data do not show if the lag is in the valve or in the sensor.
    if (finding.ingredient == Ingredient::lag)
      named.alternatives.push_back(*find_cause(causes::SensorLag::id));
    // A second lag in series would have nearly the same effect as the delay if the structure already contains
    // a lag.
    if (finding.ingredient == Ingredient::delay && chosen_.structure.lag)
      named.alternatives.push_back(*find_cause(causes::ValveLag::id));
    named.parameters = block_numbers(at_, named.block_type);
    return named;
  }

  /// Returns true if the size of a component is certain, or if it cannot be computed.
  [[nodiscard]] bool is_certain(const NamedCause& named) const {
    const auto position = model::position_of(at_.point.model, named.block_type);
    if (!position) return true;
    const auto size = size_of(at_.point.model, *position, at_.space, at_.z, at_.uncertainty);
    return !size || excludes(size->interval, 0);
  }

 private:
  const StructureTrial& chosen_;
  const BaseQuestion& question_;
  /// True: the finger does not move after a reversal of the pressure until the pressure has changed by some
  /// kPa.
  bool stands_still_;
  FitSpace space_;
  UncertainPoint at_;
};

/// Returns the latency of the finger as a finding: the delay or the lag. Each of them can largely replace the
/// other, so the data may require neither of them although the finger responds late. The finding is the
/// component whose removal increases the loss more; it represents both. Returns nullopt if a delay or a lag
/// is already named, or if no structure without both was fitted.
std::optional<NamedCause> latency_of(const std::vector<WithoutIngredient>& ablation, const Labeller& labeller,
                                     const BaseFindings& found) {
  const StructureTrial* const neither = trial_without(ablation, Ingredient::latency);
  if (neither == nullptr) return std::nullopt;
  const FindingName* missed_more = nullptr;
  double missed_mm2 = 0;
  std::vector<Cause> late{*find_cause(causes::SensorLag::id)};
  for (const FindingName& finding : names) {
    if (finding.ingredient != Ingredient::delay && finding.ingredient != Ingredient::lag) continue;
    const NamedCause one = labeller.name(finding, *trial_without(ablation, finding.ingredient));
    if (is_among(found.named, one.cause)) return std::nullopt;
    late.push_back(one.cause);
    if (missed_more == nullptr || one.gain_mm2.value > missed_mm2) {
      missed_more = &finding;
      missed_mm2 = one.gain_mm2.value;
    }
  }
  NamedCause latency = labeller.name(*missed_more, *neither);
  std::erase(late, latency.cause);
  latency.alternatives = std::move(late);
  return latency;
}

}  // namespace

std::vector<Ingredient> named_ingredients() {
  std::vector<Ingredient> list{Ingredient::latency};
  for (const FindingName& name : names) list.push_back(name.ingredient);
  return list;
}

void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search) {
  const double least_mm2 = limits::negligible_share * left_by_the_given_mm2(search);
  const Labeller labeller(search.data, found.chosen, found.fit.point, search.question);
  for (const FindingName& finding : names) {
    const StructureTrial* const without = trial_without(ablation, finding.ingredient);
    if (without == nullptr) continue;
    NamedCause named = labeller.name(finding, *without);
    if (named.gain_mm2.value < least_mm2) continue;
    if (is_among(found.named, named.cause) || is_among(found.possible, named.cause)) continue;
    const bool is_sure = named.inclusion >= limits::probability && labeller.is_certain(named);
    (is_sure ? found.named : found.possible).push_back(std::move(named));
  }
  auto latency = latency_of(ablation, labeller, found);
  if (!latency || latency->gain_mm2.value < least_mm2 || latency->inclusion < limits::probability) return;
  std::erase_if(found.possible, [&](const NamedCause& one) {
    return one.cause == latency->cause ||
           std::find(latency->alternatives.begin(), latency->alternatives.end(), one.cause) !=
               latency->alternatives.end();
  });
  found.named.push_back(std::move(*latency));
}

}  // namespace softgrip::sysid
