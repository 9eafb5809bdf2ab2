#include "sysid/changes/change_size.h"

#include <algorithm>
#include <cmath>

#include "base/statistics.h"
#include "sysid/changes/next_steps.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Returns the value of the parameter with this name, or nullptr if the effect has no such parameter.
const double* number(const FittedEffect& effect, std::string_view name) {
  for (std::size_t i = 0; i < effect.numbers.size(); ++i) {
    if (effect.effect.numbers[i].name == name) return &effect.numbers[i];
  }
  return nullptr;
}

/// Returns the rule for the size of the effect.
SizedBy rule_of(const FittedEffect& effect) {
  return effect.effect.size.value_or(sized_by(effect.effect.id));
}

/// Returns true if size_of() is the effect at full pressure.
bool is_sized_at_full_pressure(const FittedEffect& effect) {
  const SizedBy rule = rule_of(effect);
  return !is_sized_by_both_gains(effect) &&
         (rule.of == SizedBy::Of::full_pressure ||
          (rule.of == SizedBy::Of::number && number(effect, rule.number) == nullptr));
}

/// Returns the size that is stated by one parameter.
ShownSize size_by_parameter(const FittedEffect& effect, const EffectIntervals& intervals, std::size_t i) {
  const EffectNumber& number = effect.effect.numbers[i];
  // The further clauses of the description do not belong to the name of the quantity.
  const std::string name = number.meaning.substr(0, number.meaning.find_first_of(",;"));
  return {{name.empty() ? number.name : name, intervals.values[i], number.unit},
          intervals.numbers[i],
          effect.effect.nothing[i]};
}

/// Returns the index of the parameter with the largest distance from its neutral value, in half widths of its
/// interval. Returns nullopt if no interval excludes the neutral value. A parameter at a bound of its range
/// is not determined, so it is skipped.
std::optional<std::size_t> most_significant(const FittedEffect& effect, const EffectIntervals& intervals) {
  std::optional<std::size_t> most;
  double farthest = 1;
  for (std::size_t i = 0; i + effect.effect.nuisance_numbers < effect.numbers.size(); ++i) {
    const EffectNumber& number = effect.effect.numbers[i];
    const double value = intervals.values[i], neutral = effect.effect.nothing[i];
    if (!intervals.numbers[i] || !std::isfinite(neutral)) continue;
    if (!(effect.numbers[i] > number.lower && effect.numbers[i] < number.upper)) continue;
    // The interval is limited to the range of the parameter, so one of its halves can be too narrow.
    const double half = std::max(value - intervals.numbers[i]->lower, intervals.numbers[i]->upper - value);
    const double distance = std::abs(value - neutral) / half;
    if (!(distance > farthest)) continue;
    farthest = distance;
    most = i;
  }
  return most;
}

double largest_of(const Binned& series) {
  double largest = 0;
  for (const std::vector<double>& part : series) {
    for (const double v : part) {
      if (std::abs(v) > std::abs(largest)) largest = v;
    }
  }
  return largest;
}

}  // namespace

bool is_sized_by_both_gains(const FittedEffect& effect) {
  return effect.numbers.size() == 1 && number(effect, "gain_change") != nullptr;
}

FittedEffect with_whole_gain(const LaterReadings& readings, FittedEffect effect, double deviation) {
  const bool is_gain = is_sized_by_both_gains(effect) ||
                       (effect.numbers.size() == 1 && number(effect, "pressure_factor_change") != nullptr);
  if (!is_gain) return effect;
  PairSums sums;  // of the motion of the baseline model and its change by the effect
  const Binned added = readings.added({effect});
  for (std::size_t r = 0; r < added.size(); ++r) {
    for (std::size_t b = 0; b < added[r].size(); ++b) sums.add(readings.plain()[r][b], added[r][b]);
  }
  const double gain = sums.slope();
  if (std::abs(gain) > limits::negligible_share) effect.numbers.front() *= 1 + deviation / gain;
  return effect;
}

double at_full_pressure(const LaterReadings& readings, const Binned& added) {
  const std::vector<Record>& records = readings.records();
  const double largest_kpa = campaign_size(records).largest_kpa;
  double sum = 0, count = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const std::vector<double> drive = binned(records[r], records[r].drive_kpa, readings.base().bin_s);
    for (std::size_t b = 0; b < std::min(drive.size(), added[r].size()); ++b) {
      if (!(std::abs(drive[b]) > 0.9 * largest_kpa) || !std::isfinite(added[r][b])) continue;
      sum += added[r][b];
      count += 1;
    }
  }
  return count > 0 ? sum / count : 0;
}

ChangeSize size_of(const LaterReadings& readings, const FittedEffect& effect, double full_pressure_mm) {
  if (is_sized_by_both_gains(effect))
    return {"gain", 100 * (effect.numbers.front() + readings.nuisance({effect}).gain), "%"};
  const SizedBy size = rule_of(effect);
  const auto sized = [&](double value) {
    return ChangeSize{std::string(size.what), size.factor * value, std::string(size.unit)};
  };
  switch (size.of) {
    case SizedBy::Of::span:
      return sized(full_pressure_mm / readings.base().span_mm);
    case SizedBy::Of::largest:
      return sized(largest_of(readings.added({effect})));
    case SizedBy::Of::amplitude:
      return sized(std::abs(largest_of(readings.added({effect}))));
    case SizedBy::Of::number:
      if (const double* value = number(effect, size.number)) return sized(*value);
      break;
    case SizedBy::Of::full_pressure:
      break;
  }
  return {std::string(SizedBy{}.what), full_pressure_mm,
          unit_of(readings.base().judged, model::OutputUnit::mm)};
}

ShownSize shown_size(const LaterReadings& readings, const FittedEffect& effect,
                     const EffectIntervals& intervals) {
  const Binned added = readings.added({effect});
  const ShownSize size{size_of(readings, effect, at_full_pressure(readings, added)), intervals.size, 0};
  const bool is_shown = !size.interval || excludes(*size.interval, 0);
  if (!is_sized_at_full_pressure(effect) || (is_shown && std::abs(size.size.value) >= rms_of(added)))
    return size;
  const std::optional<std::size_t> parameter = most_significant(effect, intervals);
  return parameter ? size_by_parameter(effect, intervals, *parameter) : size;
}

}  // namespace softgrip::sysid
