#pragma once
// Computes the scales of the data of a campaign, such as the span and the duration. The permitted ranges of
// the parameters of causes are multiples of these scales.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Log column that the test of a cause requires.
enum class Column : std::uint8_t { none, temperature_c, supply_kpa };

/// Returns the name of a column, "temperature_c" or "supply_kpa".
[[nodiscard]] constexpr std::string_view name_of(Column column) {
  return column == Column::temperature_c ? "temperature_c" : "supply_kpa";
}

/// Scales of the data of a campaign.
struct Scales {
  double span_mm = 0;             ///< range of the displacement readings
  double largest_kpa = 0;         ///< largest pressure at the input of the model
  double campaign_s = 0;          ///< total duration of all records
  double sample_s = 0;            ///< shortest typical interval between distinct readings of all records
  double largest_supply_kpa = 0;  ///< largest supply pressure; 0: the logs have no such column
  bool has_temperature = false;   ///< true: the logs have a temperature column whose values vary
  bool has_supply = false;        ///< true: the logs have a supply column whose values vary
  bool has_valve = true;          ///< false: the input of the model is the measured pressure
  /// Significant lines in the spectrum of the residual. The most significant line comes first.
  std::vector<Line> residual_lines;

  /// Returns the shortest time constant [s] of the running-in of a finger or of the warm-up of a sensor. A
  /// faster change is attributed to the initial state of a log or to creep.
  [[nodiscard]] double soonest_s() const {
    return std::max(0.02 * campaign_s, std::min(10.0, 0.4 * campaign_s));
  }
  /// Returns the gain of the finger [mm/kPa]: the span of the readings divided by the largest pressure.
  [[nodiscard]] double gain_mm_per_kpa() const { return largest_kpa > 0 ? span_mm / largest_kpa : 1; }
  /// Returns true if the logs have the column `column` and its values vary. Returns true for Column::none.
  [[nodiscard]] bool has(Column column) const {
    return column == Column::none || (column == Column::temperature_c ? has_temperature : has_supply);
  }
};

/// Returns the scales of a campaign. Their member `residual_lines` is left empty.
[[nodiscard]] Scales scales_of(const std::vector<Record>& records);

}  // namespace softgrip::sysid
