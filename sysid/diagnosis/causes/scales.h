#pragma once
// Computes the scales of a campaign, which define the ranges of the parameters of causes.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A log column that some causes require.
enum class Column : std::uint8_t { none, temperature_c, supply_kpa };

/// Returns "temperature_c" or "supply_kpa".
[[nodiscard]] constexpr std::string_view name_of(Column column) {
  return column == Column::temperature_c ? "temperature_c" : "supply_kpa";
}

/// Scales of a campaign.
struct Scales {
  double span_mm = 0;             ///< span of the displacement
  double largest_kpa = 0;         ///< largest pressure of the drive
  double campaign_s = 0;          ///< total duration of all records
  double sample_s = 0;            ///< shortest typical interval between distinct readings
  double largest_supply_kpa = 0;  ///< largest supply pressure; 0: the logs have no such column
  bool has_temperature = false;   ///< the temperature column exists and varies
  bool has_supply = false;        ///< the supply column exists and varies
  bool has_valve = true;          ///< false: the measured pressure drives the model
  /// The significant lines in the spectrum of the residual, the most significant first.
  std::vector<Line> residual_lines;

  /// Returns the shortest time in which a finger runs in or a sensor warms up [s]. A faster change is
  /// attributed to the start of a log or to creep.
  [[nodiscard]] double soonest_s() const {
    return std::max(0.02 * campaign_s, std::min(10.0, 0.4 * campaign_s));
  }
  /// Returns the gain of the finger: span divided by the largest pressure.
  [[nodiscard]] double gain_mm_per_kpa() const { return largest_kpa > 0 ? span_mm / largest_kpa : 1; }
  /// Returns true if the column exists and varies. Returns true for Column::none.
  [[nodiscard]] bool has(Column column) const {
    return column == Column::none || (column == Column::temperature_c ? has_temperature : has_supply);
  }
};

/// Returns the scales of a campaign without the lines of the residual.
[[nodiscard]] Scales scales_of(const std::vector<Record>& records);

}  // namespace softgrip::sysid
