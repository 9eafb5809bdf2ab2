#include "sysid/changes/effects.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/blocks/ageing.h"
#include "model/blocks/clock_offset.h"
#include "model/blocks/crescent_hysteresis.h"
#include "model/blocks/duhem_hysteresis.h"
#include "model/blocks/pseudo_elastic_softening.h"
#include "model/blocks/sensor_nonlinearity.h"
#include "model/blocks/sensor_sinusoidal_drift.h"
#include "model/blocks/stiffening.h"
#include "model/blocks/stress_softening.h"
#include "model/blocks/thermal_gain.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/changes/causes_without_block.h"
#include "sysid/diagnosis/causes/thermal_gain.h"

namespace softgrip::sysid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_starts = 8;
const EffectNumber gain_change{"gain_change", "", 0.01, -0.9, 9};

/// Returns the cause that has this block as one of its forms.
template <template <class> class Block>
const Cause& cause_with() {
  return *cause_of(model::block_type<Block>());
}

/// Returns at most most_starts start points, evenly distributed over the list. If the effect has one
/// parameter, all start points are kept, because the error may have a separate minimum near each of them.
std::vector<std::vector<double>> some(std::vector<std::vector<double>> all) {
  if (all.size() <= most_starts || all.front().size() == 1) return all;
  std::vector<std::vector<double>> kept;
  for (std::size_t i = 0; i < most_starts; ++i) kept.push_back(all[i * all.size() / most_starts]);
  return kept;
}

/// Returns true if the block can be added to the finger model of the baseline.
bool is_carried(const Base& base, const model::BlockSpec& block) {
  if (base.model.blocks.empty()) return false;
  return model::validate(model::with_block(base.model, block)).empty();
}

class Collector {
 public:
  Collector(const Base& base, const std::vector<Record>& later, const std::vector<Line>& lines,
            bool pressure_is_judged)
      : base_(base), scales_(scales_of(later)), pressure_is_judged_(pressure_is_judged) {
    scales_.has_valve = base.drive == Drive::command;
    scales_.residual_lines = lines;
  }

  std::vector<Effect> collect() {
    const bool pressure = base_.judged == Judged::pressure;
    for (const Cause& cause : all_causes()) {
      const bool of_valve = cause.station == model::Station::valve;
      if (!cause.found_by_fitting || cause == cause_with<model::ThermalGain>()) continue;
      if (pressure != (of_valve && pressure_is_judged_)) continue;
      if (of_valve && base_.drive == Drive::measured) continue;
      if (!unanswerable(cause, scales_).empty()) continue;
      for (const CauseForm& form : cause.forms) add(cause, form);
    }
    if (pressure) {
      add_causes_of_the_air();
    } else {
      add_gain();
      add_load();
      add_softening();
      add_crescent();
      add_stiffening();
      add_bow();
      if (scales_.has_temperature) add_thermal();
    }
    return std::move(effects_);
  }

 private:
  void add(const Cause& cause, const CauseForm& form) {
    if (form.starts == nullptr) return;
    std::vector<model::BlockSpec> starts = form.starts(scales_);
    if (starts.empty()) return;
    const model::BlockDescriptor& descriptor = model::catalogue()[form.type];
    // The free form of sensor drift is piecewise linear. It can represent a sinusoidal drift too, so the
    // sinusoidal form is not tried.
    if (form.type == model::block_type<model::SensorSinusoidalDrift>()) return;
    // The next two blocks are skipped here. add_softening() and add_crescent() add their effects for any
    // baseline model.
    if (form.type == model::block_type<model::PseudoElasticSoftening>()) return;
    if (form.type == model::block_type<model::CrescentHysteresis>()) return;
    if (cause.station != model::Station::valve && !is_carried(base_, starts.front())) return;
    Effect effect = form_of(cause, descriptor.info.id);
    effect.free_form = form.free_form;
    std::vector<std::size_t> fitted;
    for (std::size_t i = 0; i < starts.front().values.size(); ++i) {
      if (!form.is_fitted(i)) continue;
      const model::ParameterSpec& spec = descriptor.spec(i);
      const Range range = form.range(i, scales_, base_.model);
      fitted.push_back(i);
      effect.numbers.push_back({descriptor.name(i), std::string(spec.unit), spec.scale,
                                std::max(spec.lower, range.lower), std::min(spec.upper, range.upper),
                                descriptor.former_name(i), std::string(spec.meaning)});
      effect.nothing.push_back(spec.neutral);
    }
    for (const model::BlockSpec& start : starts) {
      effect.starts.emplace_back();
      for (const std::size_t i : fitted) effect.starts.back().push_back(start.values[i]);
    }
    effect.starts = some(std::move(effect.starts));
    // The block extrapolates the motion, because it does not know later samples. A diagnosis knows them.
    if (form.type == model::block_type<model::ClockOffset>()) {
      effect.apply = [](Extension& e, const std::vector<double>& n) { e.lead_s += n[0]; };
      effects_.push_back(std::move(effect));
      return;
    }
    const bool of_valve = cause.station == model::Station::valve;
    effect.apply = [block = starts.front(), fitted, of_valve](Extension& extension,
                                                              const std::vector<double>& numbers) {
      model::BlockSpec changed = block;
      for (std::size_t i = 0; i < fitted.size(); ++i) changed.values[fitted[i]] = numbers[i];
      (of_valve ? extension.valve : extension.chain).push_back(std::move(changed));
    };
    effects_.push_back(std::move(effect));
  }

  /// Returns an effect for this form of the cause, without parameters. The caller adds the parameters.
  static Effect form_of(const Cause& cause, std::string_view form) {
    Effect effect;
    effect.id = cause.id;
    effect.title = cause.title;
    effect.station = cause.station;
    effect.form = form;
    effect.indistinguishable = cause.indistinguishable;
    effect.is_ideal = cause.is_ideal;
    effect.appears = cause.appears;
    return effect;
  }
  static Effect form_of(const CauseWithoutBlock& cause) {
    Effect effect;
    effect.id = effect.form = cause.id;
    effect.title = cause.title;
    effect.station = model::Station::valve;
    effect.appears = cause.appears;
    return effect;
  }
  /// Returns the effect that was added first for this cause. Returns nullptr if no effect of the cause can be
  /// added to the baseline model.
  Effect* first_of(const Cause& cause) {
    const auto found =
        std::find_if(effects_.begin(), effects_.end(), [&](const Effect& e) { return e.id == cause.id; });
    return found == effects_.end() ? nullptr : &*found;
  }

  /// Adds the effect of a gain that differs from the gain in the healthy logs and is constant in the later
  /// logs.
  void add_gain() {
    Effect effect = form_of(cause_with<model::Ageing>(), "another_gain");
    effect.numbers = {gain_change};
    effect.starts = {{0.02}, {-0.02}};
    effect.nothing = {0};
    effect.apply = [](Extension& e, const std::vector<double>& n) { e.gain *= 1 + n[0]; };
    effects_.push_back(std::move(effect));
  }
  /// Adds a different modulus of the material, and a weight. Both change the load line of the finger. For a
  /// finger with a nonlinear characteristic, they differ from a gain of the sensor and from a zero offset.
  void add_load() {
    const double p = base_.largest_kpa;
    Effect softer = form_of(cause_with<model::Ageing>(), "another_modulus");
    softer.numbers = {{"pressure_factor_change", "", 0.01, -0.9, 9}};
    softer.starts = {{0.02}, {-0.02}};
    softer.nothing = {0};
    softer.apply = [](Extension& e, const std::vector<double>& n) { e.load.factor *= 1 + n[0]; };
    effects_.push_back(std::move(softer));
    Effect weight = form_of(payload);
    weight.station = model::Station::load;
    weight.form = "weight";
    weight.size = SizedBy{SizedBy::Of::number, "pressure that balances the load", "kPa", "weight_kpa"};
    weight.numbers = {{"weight_kpa", "kPa", 0.5, -0.5 * p, 0.5 * p}};
    weight.starts = {{0.03 * p}, {-0.03 * p}};
    weight.nothing = {0};
    weight.apply = [](Extension& e, const std::vector<double>& n) { e.load.weight_kpa += n[0]; };
    effects_.push_back(std::move(weight));
  }
  void add_softening() {
    const double p = base_.largest_kpa;
    const EffectNumber share{
        "share", "", 0.02, 0, 3, {}, "relative increase of the displacement by softening"};
    Effect below = form_of(cause_with<model::StressSoftening>(), "softer_below_the_largest");
    below.numbers = {share, {"range_kpa", "kPa", 5, 0.02 * p, 2 * p}};
    below.starts = {{0.03, 0.2 * p}, {0.03, 0.6 * p}};
    below.nothing = {0, nan};
    below.apply = [](Extension& e, const std::vector<double>& n) { e.softening = {n[0], n[1]}; };
    effects_.push_back(std::move(below));
    Effect since = form_of(cause_with<model::StressSoftening>(), "softer_since_the_largest");
    since.numbers = {share};
    since.starts = {{0.03}};
    since.nothing = {0};
    since.apply = [](Extension& e, const std::vector<double>& n) { e.softening = {n[0], 0}; };
    effects_.push_back(std::move(since));
  }
  /// Adds the effect of a hysteresis loop whose loading curve and unloading curve differ. The baseline model
  /// need not be a Bouc-Wen model.
  void add_crescent() {
    Effect effect = form_of(cause_with<model::DuhemHysteresis>(), "crescent");
    effect.numbers = {{"share", "", 0.05, 0, 3, {}, "size of the hysteresis loop as a share of the span"},
                      {"exponent", "", 1, 1.2, 6}};
    effect.starts = {{0.05, 1.8}, {0.05, 3.5}};
    effect.nothing = {0, nan};
    effect.apply = [](Extension& e, const std::vector<double>& n) { e.crescent = {n[0], n[1]}; };
    effects_.push_back(std::move(effect));
  }
  /// Adds the effect of stiffening. The displacement at which stiffening leaves the gain unchanged is
  /// unknown, so a gain is fitted together with the curvature.
  void add_stiffening() {
    Effect* const plain = first_of(cause_with<model::Stiffening>());
    if (plain == nullptr) return;
    // Stiffening decreases the gain at larger displacements, so the parameter must not be negative.
    plain->numbers[0].lower = 0;
    std::erase_if(plain->starts, [](const std::vector<double>& start) { return start[0] < 0; });
    Effect effect = *plain;
    effect.nuisance_numbers = 1;
    effect.form = "stiffening_about_a_point";
    effect.numbers.push_back(gain_change);
    effect.nothing.push_back(0);
    for (std::vector<double>& start : effect.starts) start.push_back(start[0] * 0.5 * base_.span_mm);
    effect.apply = [bend = plain->apply](Extension& e, const std::vector<double>& n) {
      bend(e, {n[0]});
      e.gain *= 1 + n[1];
    };
    effects_.push_back(std::move(effect));
  }
  /// Adds the effect of a nonlinear sensor whose curve bends in one direction only.
  void add_bow() {
    const Effect* const bent = first_of(cause_with<model::SensorNonlinearity>());
    if (bent == nullptr) return;
    Effect effect = *bent;
    effect.form = "bow";
    effect.numbers.resize(1);
    effect.nothing.resize(1);
    for (std::vector<double>& start : effect.starts) start.resize(1);
    effect.apply = [bend = bent->apply](Extension& e, const std::vector<double>& n) { bend(e, {n[0], 0}); };
    effects_.push_back(std::move(effect));
  }
  /// Adds the effect of the temperature on the gain. The temperature at which the gain equals the healthy
  /// gain is unknown, so a gain is fitted together with the temperature coefficient.
  void add_thermal() {
    Effect effect = form_of(cause_with<model::ThermalGain>(), causes::ThermalGain::id);
    effect.numbers = {{"gain_per_c", "1/degC", 0.002, -0.2, 0.2}, gain_change};
    effect.starts = {{0.01, 0}, {-0.01, 0}};
    effect.nothing = {0, 0};
    effect.apply = [](Extension& e, const std::vector<double>& n) {
      e.gain_per_c += n[0];
      e.gain *= 1 + n[1];
    };
    effects_.push_back(std::move(effect));
  }
  void add_causes_of_the_air() {
    if (base_.regulator) add_faults();
    const double p = base_.largest_kpa;
    Effect lost = form_of(leak);
    lost.numbers = {{"loss_kpa_per_s", "kPa/s", 0.1, 0, p},
                    {"recovery_s", "s", 2, 0.05, 200},
                    {"way_kpa", "kPa", 1, 0.05, 10 * p}};
    lost.starts = {{0.1, 1, 2}, {0.1, 10, 2}, {0.5, 0.3, 10}, {0.1, 5, 100}, {0.1, 5, 10}};
    lost.nothing = {0, nan, nan};
    lost.apply = [](Extension& e, const std::vector<double>& n) { e.loss = {n[0], n[1], n[2]}; };
    effects_.push_back(std::move(lost));
    Effect slow = form_of(blocked_line);
    slow.numbers = {{"filling_s", "s", 0.02, 0, 10}, {"venting_s", "s", 0.02, 0, 10}};
    slow.starts = {{0.02, 0.04}, {0.1, 0.2}};
    slow.nothing = {0, 0};
    slow.apply = [](Extension& e, const std::vector<double>& n) { e.line = {n[0], n[1]}; };
    effects_.push_back(std::move(slow));
  }

  /// Adds the faults of the regulator. The baseline model must contain this regulator.
  void add_faults() {
    const double p = base_.largest_kpa, per_s = leaking_kpa_per_s(p);
    Effect leaking = form_of(leak);
    leaking.form = "leak_past_a_regulator";
    leaking.numbers = {{"loss_kpa_per_s", "kPa/s", 0.1, 0, 20 * p}};
    for (const double share : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) leaking.starts.push_back({share * p});
    leaking.nothing = {0};
    leaking.apply = [per_s](Extension& e, const std::vector<double>& n) {
      e.fault.leak_per_s += n[0] / per_s;
    };
    effects_.push_back(std::move(leaking));
    Effect narrow = form_of(blocked_line);
    narrow.form = "narrower_tube";
    narrow.size = SizedBy{SizedBy::Of::number, "reduction of the air flow", "%", "blocked", 100};
    narrow.numbers = {{"blocked", "", 0.1, 0, 0.99}};
    narrow.starts = {{0.05}, {0.3}};
    narrow.nothing = {0};
    narrow.apply = [](Extension& e, const std::vector<double>& n) { e.fault.blocked += n[0]; };
    effects_.push_back(std::move(narrow));
  }

  const Base& base_;
  Scales scales_;
  bool pressure_is_judged_;
  std::vector<Effect> effects_;
};

}  // namespace

Extension extension_of(const std::vector<FittedEffect>& effects) {
  Extension extension;
  for (const FittedEffect& each : effects) each.effect.apply(extension, each.numbers);
  return extension;
}

std::vector<Effect> effects_for(const Base& base, const std::vector<Record>& later,
                                const std::vector<Line>& lines, bool pressure_is_judged) {
  return Collector(base, later, lines, pressure_is_judged).collect();
}

}  // namespace softgrip::sysid
