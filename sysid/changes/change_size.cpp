#include "sysid/changes/change_size.h"

#include <algorithm>
#include <cmath>

namespace softgrip::sysid {
namespace {

/// The number of an effect by its name; nullptr: it has none of that name.
const double* number(const FittedEffect& effect, std::string_view name) {
  for (std::size_t i = 0; i < effect.numbers.size(); ++i) {
    if (effect.effect.numbers[i].name == name) return &effect.numbers[i];
  }
  return nullptr;
}

struct Direct {
  std::string_view id, number, what, unit;
  double factor;
};

/// Numbers that a technician checks as they are.
constexpr Direct direct[] = {
    {"transport_delay", "delay_s", "more dead time", "s", 1},
    {"valve_lag", "time_constant_s", "more lag of the valve", "s", 1},
    {"blocked_line", "filling_s", "more time to fill", "s", 1},
    {"sensor_lag", "time_constant_s", "lag of the sensor", "s", 1},
    {"valve_deadband", "band_kpa", "band that the valve ignores", "kPa", 1},
    {"pressure_saturation", "limit_kpa", "the pressure stops at", "kPa", 1},
    {"actuator_threshold", "threshold_kpa", "pressure before anything moves", "kPa", 1},
    {"supply_sag", "coupling", "of a loss of supply that reaches the finger", "%", 100},
    {"thermal_gain", "gain_per_c", "gain per degree", "%", 100},
    {"backlash", "gap_mm", "play", "mm", 1},
};

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

double at_full_pressure(const LaterReadings& readings, const Binned& added) {
  const std::vector<Record>& records = readings.records();
  double largest_kpa = 0, sum = 0, count = 0;
  for (const Record& record : records) largest_kpa = std::max(largest_kpa, record.largest_kpa);
  for (std::size_t r = 0; r < records.size(); ++r) {
    const std::vector<double> drive = binned(records[r], records[r].drive_kpa, readings.base().bin_s);
    for (std::size_t b = 0; b < std::min(drive.size(), added[r].size()); ++b) {
      if (!(drive[b] > 0.9 * largest_kpa) || !std::isfinite(added[r][b])) continue;
      sum += added[r][b];
      count += 1;
    }
  }
  return count > 0 ? sum / count : 0;
}

ChangeSize size_of(const LaterReadings& readings, const FittedEffect& effect, double full_pressure_mm) {
  if (effect.effect.id == "leak")
    return {"pressure lost while it holds", largest_of(readings.added({effect})), "kPa"};
  if (effect.effect.id == "sensor_drift")
    return {"the zero wanders by up to", largest_of(readings.added({effect})), "mm"};
  if (effect.effect.id == "periodic_disturbance")
    return {"oscillation of", std::abs(largest_of(readings.added({effect}))), "mm"};
  // Of another gain, what counts as no change is a part.
  if (effect.effect.id == "ageing" && effect.numbers.size() == 1 && number(effect, "gain_change") != nullptr)
    return {"gain", 100 * (effect.numbers[0] + readings.slack({effect}).gain), "%"};
  if (effect.effect.id == "ageing")
    return {"gain at full pressure, on average", 100 * full_pressure_mm / readings.base().span_mm, "%"};
  for (const Direct& known : direct) {
    if (known.id != effect.effect.id) continue;
    if (const double* value = number(effect, known.number))
      return {std::string(known.what), *value * known.factor, std::string(known.unit)};
  }
  return {"at full pressure", full_pressure_mm, unit_of(readings.base().judged)};
}

}  // namespace softgrip::sysid
