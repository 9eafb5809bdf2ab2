#include "control/elements/limits.h"

namespace softgrip::control {

double in_range(const LimitSettings& limits, double pressure_kpa) noexcept {
  return std::clamp(pressure_kpa, limits.pressure_min_kpa, limits.pressure_max_kpa);
}

LimitedCommand limit(const LimitSettings& limits, double wanted_kpa, double last_kpa, double elapsed_s,
                     double ceiling_kpa) noexcept {
  // If the last command is not finite, the rest pressure is the only pressure that is known to be safe.
  const double last = std::isfinite(last_kpa) ? in_range(limits, last_kpa) : resting_kpa(limits);
  if (std::isnan(wanted_kpa) || std::isnan(ceiling_kpa) || !(elapsed_s >= 0))
    return {.command_kpa = last, .invalid = true};
  // A ceiling below the rest pressure is replaced by the rest pressure. Otherwise, a low ceiling would
  // evacuate a finger, or stop a finger that returns to rest.
  const double highest_kpa = std::max(ceiling_kpa, resting_kpa(limits));
  const bool capped = wanted_kpa > highest_kpa;
  const double inside = in_range(limits, capped ? highest_kpa : wanted_kpa);
  const double reached = std::clamp(inside, last - limits.slew_down_kpa_per_s * elapsed_s,
                                    last + limits.slew_up_kpa_per_s * elapsed_s);
  return {.command_kpa = reached,
          .saturated = in_range(limits, wanted_kpa) != wanted_kpa,
          .slewing = reached != inside,
          .capped = capped};
}

LimitedReference limit_reference(const LimitSettings& limits, double reference_mm) noexcept {
  const double inside = std::clamp(reference_mm, limits.displacement_min_mm, limits.displacement_max_mm);
  return {inside, inside != reference_mm};
}

bool displacement_beyond(const LimitSettings& limits, double displacement_mm) noexcept {
  return !(displacement_mm >= limits.displacement_min_mm - limits.displacement_margin_mm &&
           displacement_mm <= limits.displacement_max_mm + limits.displacement_margin_mm);
}

}  // namespace softgrip::control
