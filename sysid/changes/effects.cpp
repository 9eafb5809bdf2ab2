#include "sysid/changes/effects.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/blocks/ageing.h"
#include "model/catalogue.h"

namespace softgrip::sysid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_starts = 8;

/// Thinned evenly, but for one number: where many values are worth a look, each is a valley of its own.
std::vector<std::vector<double>> some(std::vector<std::vector<double>> all) {
  if (all.size() <= most_starts || all.front().size() == 1) return all;
  std::vector<std::vector<double>> kept;
  for (std::size_t i = 0; i < most_starts; ++i) kept.push_back(all[i * all.size() / most_starts]);
  return kept;
}

/// Whether the base can carry the block at all.
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
      if (!cause.found_by_fitting || cause.id == "thermal_gain") continue;
      if (pressure != (of_valve && pressure_is_judged_)) continue;
      if (of_valve && base_.drive == Drive::measured) continue;
      if (!unanswerable(cause, scales_).empty()) continue;
      for (const CauseForm& form : cause.forms) add(cause, form);
    }
    if (pressure) {
      add_leak();
    } else {
      add_gain();
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
    const model::Descriptor& descriptor = model::catalogue()[form.type];
    if (descriptor.info.id == std::string_view("sensor_wander")) return;  // knots follow it too
    if (cause.station != model::Station::valve && !is_carried(base_, starts.front())) return;
    Effect effect{std::string(cause.id),
                  std::string(cause.title),
                  cause.station,
                  std::string(descriptor.info.id),
                  form.free_form,
                  {},
                  {},
                  {},
                  {}};
    effect.contains = cause.contains;
    effect.limit = cause.limit;
    effect.twin = cause.twin;
    effect.where_bases_miss = cause.where_bases_miss;
    std::vector<std::size_t> fitted;
    for (std::size_t i = 0; i < starts.front().values.size(); ++i) {
      if (!form.is_fitted(i)) continue;
      const model::ParameterSpec& spec = descriptor.spec(i);
      const Range range = form.range(i, scales_, base_.model);
      fitted.push_back(i);
      effect.numbers.push_back({descriptor.name(i), std::string(spec.unit), spec.scale,
                                std::max(spec.lower, range.lower), std::min(spec.upper, range.upper)});
      effect.nothing.push_back(spec.neutral);
    }
    for (const model::BlockSpec& start : starts) {
      effect.starts.emplace_back();
      for (const std::size_t i : fitted) effect.starts.back().push_back(start.values[i]);
    }
    effect.starts = some(std::move(effect.starts));
    const bool of_valve = cause.station == model::Station::valve;
    effect.apply = [block = starts.front(), fitted, of_valve](Extension& extension,
                                                              const std::vector<double>& numbers) {
      model::BlockSpec changed = block;
      for (std::size_t i = 0; i < fitted.size(); ++i) changed.values[fitted[i]] = numbers[i];
      (of_valve ? extension.valve : extension.chain).push_back(std::move(changed));
    };
    effects_.push_back(std::move(effect));
  }

  /// The gain is another than it was, once and for all.
  void add_gain() {
    effects_.push_back({"ageing",
                        "Ageing",
                        model::Station::actuator,
                        "another_gain",
                        false,
                        {{"gain_change", "", 0.01, -0.9, 9}},
                        {{0.02}, {-0.02}},
                        {0},
                        [](Extension& e, const std::vector<double>& n) { e.gain *= 1 + n[0]; }});
  }
  void add_softening() {
    const double p = base_.largest_kpa;
    effects_.push_back({"stress_softening",
                        "Stress softening",
                        model::Station::actuator,
                        "softer_below_the_largest",
                        false,
                        {{"share", "", 0.02, 0, 3}, {"range_kpa", "kPa", 5, 0.02 * p, 2 * p}},
                        {{0.03, 0.2 * p}, {0.03, 0.6 * p}},
                        {0, nan},
                        [](Extension& e, const std::vector<double>& n) {
                          e.softening = {n[0], n[1]};
                        }});
    effects_.push_back({"stress_softening",
                        "Stress softening",
                        model::Station::actuator,
                        "softer_since_the_largest",
                        false,
                        {{"share", "", 0.02, 0, 3}},
                        {{0.03}},
                        {0},
                        [](Extension& e, const std::vector<double>& n) {
                          e.softening = {n[0], 0};
                        }});
  }
  /// Of a base without Bouc-Wen's loop, a loop that is wider on one side.
  void add_crescent() {
    effects_.push_back({"asymmetric_hysteresis",
                        "Asymmetric hysteresis",
                        model::Station::actuator,
                        "crescent",
                        false,
                        {{"share", "", 0.05, 0, 3}, {"exponent", "", 1, 1.2, 6}},
                        {{0.05, 1.8}, {0.05, 3.5}},
                        {0, nan},
                        [](Extension& e, const std::vector<double>& n) {
                          e.crescent = {n[0], n[1]};
                        }});
  }
  /// At which displacement the gain is still what it was, nobody knows: beside the bend goes a gain.
  void add_stiffening() {
    const auto plain =
        std::find_if(effects_.begin(), effects_.end(), [](const Effect& e) { return e.id == "stiffening"; });
    if (plain == effects_.end()) return;
    // What gives way more the farther it is bent has not stiffened.
    plain->numbers[0].lower = 0;
    std::erase_if(plain->starts, [](const std::vector<double>& start) { return start[0] < 0; });
    Effect effect = *plain;
    effect.slack_numbers = 1;
    effect.form = "stiffening_about_a_point";
    effect.numbers.push_back({"gain_change", "", 0.01, -0.9, 9});
    effect.nothing.push_back(0);
    for (std::vector<double>& start : effect.starts) start.push_back(start[0] * 0.5 * base_.span_mm);
    effect.apply = [bend = plain->apply](Extension& e, const std::vector<double>& n) {
      bend(e, {n[0]});
      e.gain *= 1 + n[1];
    };
    effects_.push_back(std::move(effect));
  }
  /// A scale that is bent to one side only.
  void add_bow() {
    const auto bent = std::find_if(effects_.begin(), effects_.end(),
                                   [](const Effect& e) { return e.id == "sensor_nonlinearity"; });
    if (bent == effects_.end()) return;
    Effect effect = *bent;
    effect.form = "bow";
    effect.numbers.resize(1);
    effect.nothing.resize(1);
    for (std::vector<double>& start : effect.starts) start.resize(1);
    effect.apply = [bend = bent->apply](Extension& e, const std::vector<double>& n) { bend(e, {n[0], 0}); };
    effects_.push_back(std::move(effect));
  }
  /// At which temperature the gain is still what it was, nobody knows: beside the slope goes a gain.
  void add_thermal() {
    effects_.push_back({"thermal_gain",
                        "Thermal gain",
                        model::Station::actuator,
                        "thermal_gain",
                        false,
                        {{"gain_per_c", "1/degC", 0.002, -0.2, 0.2}, {"gain_change", "", 0.01, -0.9, 9}},
                        {{0.01, 0}, {-0.01, 0}},
                        {0, 0},
                        [](Extension& e, const std::vector<double>& n) {
                          e.gain_per_c += n[0];
                          e.gain *= 1 + n[1];
                        }});
  }
  void add_leak() {
    const double p = base_.largest_kpa;
    effects_.push_back({"leak",
                        "Leak",
                        model::Station::valve,
                        "leak",
                        false,
                        {{"loss_kpa_per_s", "kPa/s", 0.1, 0, p},
                         {"recovery_s", "s", 2, 0.05, 200},
                         {"way_kpa", "kPa", 1, 0.05, 10 * p}},
                        {{0.1, 1, 2}, {0.1, 10, 2}, {0.5, 0.3, 10}, {0.1, 5, 100}, {0.1, 5, 10}},
                        {0, nan, nan},
                        [](Extension& e, const std::vector<double>& n) {
                          e.loss = {n[0], n[1], n[2]};
                        }});
    effects_.push_back({"blocked_line",
                        "Blocked line",
                        model::Station::valve,
                        "blocked_line",
                        false,
                        {{"filling_s", "s", 0.02, 0, 10}, {"venting_s", "s", 0.02, 0, 10}},
                        {{0.02, 0.04}, {0.1, 0.2}},
                        {0, 0},
                        [](Extension& e, const std::vector<double>& n) {
                          e.line = {n[0], n[1]};
                        },
                        "valve_lag"});
  }

  const Base& base_;
  Scales scales_;
  bool pressure_is_judged_;
  std::vector<Effect> effects_;
};

}  // namespace

std::vector<Effect> effects_for(const Base& base, const std::vector<Record>& later,
                                const std::vector<Line>& lines, bool pressure_is_judged) {
  return Collector(base, later, lines, pressure_is_judged).collect();
}

}  // namespace softgrip::sysid
