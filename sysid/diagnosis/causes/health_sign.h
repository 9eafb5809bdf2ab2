#pragma once
// Defines the indicators that are computed from a recorded grip, and the directions in which causes change
// them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace softgrip::sysid {

/// Indicators of one finger in one recorded run.
enum class HealthNumber : std::uint8_t {
  gain,           ///< displacement at full pressure in free motion
  zero,           ///< reading at rest before the first motion, relative to the baseline
  lag,            ///< delay of the free motion, compared with the baseline
  creep,          ///< creep at constant pressure minus creep in the baseline
  loop_width,     ///< displacement during unloading minus displacement during unloading in the baseline
  pressure_loss,  ///< command minus measured pressure during HOLDING
  leak,           ///< pressure decrease per second while the command is constant
  contact,        ///< reading at which the finger touches the object
  time_to_grip,   ///< time from the first step of the sequence to the result HOLDING
};
inline constexpr std::size_t health_numbers = static_cast<std::size_t>(HealthNumber::time_to_grip) + 1;

struct HealthNumberInfo {
  std::string_view id;     ///< key of the indicator in JSON; the key includes the unit
  std::string_view title;  ///< display name of the indicator, for example "gain (at full pressure)"
  std::string_view unit;
};
inline constexpr std::array<HealthNumberInfo, health_numbers> health_number_infos{{
    {"gain_mm", "gain (at full pressure)", "mm"},
    {"zero_mm", "zero", "mm"},
    {"lag_s", "lag relative to the baseline", "s"},
    {"creep_mm", "creep relative to the baseline", "mm"},
    {"loop_width_mm", "loop width relative to the baseline", "mm"},
    {"pressure_loss_kpa", "pressure loss while holding", "kPa"},
    {"leak_kpa_per_s", "pressure decay while holding", "kPa/s"},
    {"contact_mm", "contact", "mm"},
    {"time_to_grip_s", "time to grip", "s"},
}};
[[nodiscard]] constexpr const HealthNumberInfo& info_of(HealthNumber number) {
  return health_number_infos[static_cast<std::size_t>(number)];
}

/// Direction in which a cause changes an indicator.
enum class Moves : std::uint8_t { not_at_all, up, down, either_way };

/// An indicator that a cause changes, and the direction in which it changes.
struct HealthSign {
  HealthNumber number = HealthNumber::gain;
  Moves moves = Moves::not_at_all;
};
/// The indicators that a cause changes. Unused elements have the direction Moves::not_at_all.
using HealthSigns = std::array<HealthSign, 4>;

}  // namespace softgrip::sysid
