#pragma once
// Computes the scales of a measurement campaign, for example its span and its duration. The permitted ranges
// of the parameters of causes are multiples of these scales.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Log column without which a cause cannot be tested.
enum class Column : std::uint8_t { none, temperature_c, supply_kpa };

/// Returns the name of the column: "temperature_c" or "supply_kpa".
[[nodiscard]] constexpr std::string_view name_of(Column column) {
  return column == Column::temperature_c ? "temperature_c" : "supply_kpa";
}

/// Scales of a measurement campaign, that is, of all records together.
struct Scales {
  double span_mm = 0;             ///< range of the displacement readings
  double step_mm = 0;             ///< size of the steps of the readings if the sensor is coarse, otherwise 0
  double largest_kpa = 0;         ///< largest pressure at the input of the model
  double campaign_s = 0;          ///< total duration of all records
  double sample_s = 0;            ///< typical interval between two distinct readings, in the record where
                                  ///< this interval is smallest
  double time_unit_s = 1;         ///< result of time_unit_s() for the records: 1 s for a finger
  double largest_supply_kpa = 0;  ///< largest supply pressure; 0: the logs have no such column
  bool has_temperature = false;   ///< true: the logs have a temperature column whose values vary
  bool has_supply = false;        ///< true: the logs have a supply column whose values vary
  bool has_valve = true;          ///< true: the model includes the valve; false: the input of the model is
                                  ///< the measured pressure
  /// Significant lines in the spectrum of the residual. The most significant line comes first.
  std::vector<Line> residual_lines;

  /// Returns a lower limit of two time constants [s]: the running-in of a finger and the warm-up of a sensor.
  /// Faster changes are attributed to the initial state of a log or to creep.
  [[nodiscard]] double soonest_s() const {
    return std::max(0.02 * campaign_s, std::min(10.0, 0.4 * campaign_s));
  }
  /// Returns times [s] that are stated in multiples of time_unit_s.
  [[nodiscard]] std::vector<double> times_s(std::vector<double> multiples) const {
    for (double& each : multiples) each *= time_unit_s;
    return multiples;
  }
  /// Returns the gain of the finger [mm/kPa]: the span of the readings divided by the largest pressure.
  [[nodiscard]] double gain_mm_per_kpa() const { return largest_kpa > 0 ? span_mm / largest_kpa : 1; }
  /// Returns true if the logs have this column and its values vary. For Column::none, always returns true.
  [[nodiscard]] bool has(Column column) const {
    return column == Column::none || (column == Column::temperature_c ? has_temperature : has_supply);
  }
};

/// Returns the scales of a measurement campaign. The member `residual_lines` of the result is empty.
[[nodiscard]] Scales scales_of(const std::vector<Record>& records);

}  // namespace softgrip::sysid
