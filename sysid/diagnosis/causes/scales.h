#pragma once
// Defines the sizes at which causes can act, as the data show them.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A log column that some causes require.
enum class Column : std::uint8_t { none, temperature_c, supply_kpa };

/// "temperature_c", "supply_kpa"
[[nodiscard]] constexpr std::string_view name_of(Column column) {
  return column == Column::temperature_c ? "temperature_c" : "supply_kpa";
}

/// Sizes of a campaign.
struct Scales {
  double span_mm = 0;             ///< span of the displacement
  double largest_kpa = 0;         ///< largest pressure of the drive
  double campaign_s = 0;          ///< all records together
  double sample_s = 0;            ///< shortest usual interval between distinct readings
  double largest_supply_kpa = 0;  ///< 0: no such column
  bool has_temperature = false;   ///< the column exists and varies
  bool has_supply = false;        ///< the column exists and varies
  bool has_valve = true;          ///< false: the measured pressure drives the model
  /// The significant lines in the spectrum of the residual, most significant first.
  std::vector<Line> residual_lines;

  /// Returns the shortest time in which a finger runs in or a sensor warms up. Faster effects belong to the
  /// start of a log or to creep.
  [[nodiscard]] double soonest_s() const {
    return std::max(0.02 * campaign_s, std::min(10.0, 0.4 * campaign_s));
  }
  /// Returns the gain of the finger over its whole pressure range.
  [[nodiscard]] double gain_mm_per_kpa() const { return largest_kpa > 0 ? span_mm / largest_kpa : 1; }
  /// Returns true if the column exists and varies.
  [[nodiscard]] bool has(Column column) const {
    return column == Column::none || (column == Column::temperature_c ? has_temperature : has_supply);
  }
};

/// Returns the scales of a campaign, without the peaks of the residual.
[[nodiscard]] Scales scales_of(const std::vector<Record>& records);

}  // namespace softgrip::sysid
