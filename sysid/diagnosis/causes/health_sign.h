#pragma once
// The few numbers by which a recorded grip is scored, and how a cause moves them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace softgrip::sysid {

/// Of one finger in one recorded run.
enum class HealthNumber : std::uint8_t {
  gain,           ///< displacement at full pressure, as free motion shows it
  zero,           ///< reading at rest before the first motion, beyond the base
  lag,            ///< by how much free motion comes later than the base says
  creep,          ///< how much farther than the base it goes on while its pressure stands still
  loop_width,     ///< how much higher than the base it is on its way back
  pressure_loss,  ///< command minus measured pressure while it holds
  leak,           ///< by how much the measured pressure falls per second while the command stands still
  contact,        ///< reading at the touch
  time_to_grip,   ///< from the first step to HOLDING
};
inline constexpr std::size_t health_numbers = 9;

struct HealthNumberInfo {
  std::string_view id;     ///< as in JSON, with its unit
  std::string_view title;  ///< "gain", for people
  std::string_view unit;
};
inline constexpr std::array<HealthNumberInfo, health_numbers> health_number_infos{{
    {"gain_mm", "gain (at full pressure)", "mm"},
    {"zero_mm", "zero", "mm"},
    {"lag_s", "lag beyond the base", "s"},
    {"creep_mm", "creep beyond the base", "mm"},
    {"loop_width_mm", "loop width beyond the base", "mm"},
    {"pressure_loss_kpa", "pressure lost while holding", "kPa"},
    {"leak_kpa_per_s", "pressure decay while holding", "kPa/s"},
    {"contact_mm", "contact", "mm"},
    {"time_to_grip_s", "time to grip", "s"},
}};
[[nodiscard]] constexpr const HealthNumberInfo& info_of(HealthNumber number) {
  return health_number_infos[static_cast<std::size_t>(number)];
}

/// Which way a number goes.
enum class Moves : std::uint8_t { not_at_all, up, down, either_way };

/// One number that a cause moves.
struct HealthSign {
  HealthNumber number = HealthNumber::gain;
  Moves moves = Moves::not_at_all;
};
/// Those that a cause moves; the rest of the array stays as it is.
using HealthSigns = std::array<HealthSign, 4>;

}  // namespace softgrip::sysid
