#pragma once
// Defines the limits of a command and applies them. All commands of the control loop and of the feedforward
// plan pass through limit(), which keeps them within the pressure range and the slew limits. The safe output
// (ChannelOutput::safe_kpa) is written when the loop stops or its commands time out. The safe output is
// either the last command, or the rest pressure without a slew limit.

#include <algorithm>
#include <cmath>
#include <limits>

namespace softgrip::control {

/// Limits of one channel. The rig file must give a value for every member except rest_kpa, because no default
/// is suitable for all rigs.
struct LimitSettings {
  double pressure_min_kpa = 0;
  double pressure_max_kpa = 0;        ///< largest command; it must be above pressure_min_kpa
  double slew_up_kpa_per_s = 0;       ///< > 0; largest rate of increase of the command
  double slew_down_kpa_per_s = 0;     ///< > 0; largest rate of decrease of the command
  double displacement_min_mm = 0;     ///< lower limit of displacement references
  double displacement_max_mm = 0;     ///< upper limit of displacement references; it must be above
                                      ///< displacement_min_mm
  double displacement_margin_mm = 0;  ///< >= 0; a reading outside the displacement range by more than this
                                      ///< margin is a fault
  double rest_kpa = 0;  ///< pressure of every safe state; resting_kpa() limits it to the pressure range
};

/// A command that is within the limits, and the limits that changed the request.
struct LimitedCommand {
  double command_kpa = 0;
  bool saturated = false;  ///< the requested pressure is outside the pressure range
  bool slewing = false;    ///< the requested pressure is further from the last command than the slew limits
                           ///< allow
  bool invalid = false;    ///< the request, the ceiling or the elapsed time is not a number, or the elapsed
                           ///< time is negative, so the last command is held
  bool capped = false;     ///< the requested pressure is above the ceiling
};

/// Returns `pressure_kpa`, limited to the pressure range.
[[nodiscard]] double in_range(const LimitSettings& limits, double pressure_kpa) noexcept;

/// Returns the pressure of every safe state: `rest_kpa`, limited to the pressure range.
[[nodiscard]] inline double resting_kpa(const LimitSettings& limits) noexcept {
  return std::max(limits.pressure_min_kpa, std::min(limits.rest_kpa, limits.pressure_max_kpa));
}

/// Returns the pressure `kpa`, limited to the interval between `rest_kpa` and `bound_kpa`. `bound_kpa` may be
/// above or below `rest_kpa`. An infinite bound does not limit the pressure.
[[nodiscard]] inline double no_further(double rest_kpa, double kpa, double bound_kpa) noexcept {
  if (std::isinf(bound_kpa)) return kpa;
  return std::clamp(kpa, std::min(rest_kpa, bound_kpa), std::max(rest_kpa, bound_kpa));
}

/// Returns the end of the pressure range that is further from the rest pressure. If the rest pressure is one
/// end of the range, the result is the opposite end.
[[nodiscard]] inline double far_end_kpa(const LimitSettings& limits) noexcept {
  const double rest_kpa = resting_kpa(limits);
  const bool above = limits.pressure_max_kpa - rest_kpa >= rest_kpa - limits.pressure_min_kpa;
  return above ? limits.pressure_max_kpa : limits.pressure_min_kpa;
}

/// Returns true if a pressure differs from the rest pressure by more than 0.1 kPa, so that the channel counts
/// as pressurised.
[[nodiscard]] inline bool pressed(const LimitSettings& limits, double pressure_kpa) noexcept {
  constexpr double unpressed_kpa = 0.1;
  return std::abs(pressure_kpa - resting_kpa(limits)) > unpressed_kpa;
}

/// Value of a ceiling that has no effect, so that the pressure range alone bounds the command.
inline constexpr double no_ceiling = std::numeric_limits<double>::infinity();

/// Returns the command for the requested pressure `wanted_kpa`. `last_kpa` is the command that was written
/// `elapsed_s` (>= 0) ago. The result is always inside the pressure range, even if the last command was
/// outside. Inside the pressure range, the slew limits apply too. If the ceiling is below the last command,
/// the command decreases to the ceiling as fast as the slew limits permit. A ceiling below the rest pressure
/// has the effect of a ceiling at the rest pressure. If the elapsed time is not a number or negative, the
/// last command is held.
[[nodiscard]] LimitedCommand limit(const LimitSettings& limits, double wanted_kpa, double last_kpa,
                                   double elapsed_s, double ceiling_kpa = no_ceiling) noexcept;

/// A reference, limited to the displacement range.
struct LimitedReference {
  double reference_mm = 0;
  bool clamped = false;
};
[[nodiscard]] LimitedReference limit_reference(const LimitSettings& limits, double reference_mm) noexcept;

/// Returns true if a reading is outside the displacement range by more than the margin, or is not a number.
[[nodiscard]] bool displacement_beyond(const LimitSettings& limits, double displacement_mm) noexcept;

}  // namespace softgrip::control
