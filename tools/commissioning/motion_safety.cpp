#include "tools/commissioning/motion_safety.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/elements/limits.h"
#include "rig/rig_file.h"

namespace softgrip::tools {
namespace {

/// Smallest tolerance of a measured pressure [kPa].
constexpr double least_tolerance_kpa = 1;

}  // namespace

bool may_hold_a_part(const rig::RigFile& rig) {
  const auto& safety = rig.settings.safety;
  const bool holds =
      std::any_of(safety.safe_action.begin(), safety.safe_action.end(),
                  [](control::SafeAction action) { return action == control::SafeAction::hold; });
  return holds && !safety.board_vents_when_silent;
}

bool pressure_beyond(const rig::RigFile& rig, std::size_t channel, double pressure_kpa) {
  const control::LimitSettings& limits = rig.settings.channels[channel].limits;
  const double tolerance_kpa = std::max(rig.settings.faults.pressure_tolerance_kpa, least_tolerance_kpa);
  return pressure_kpa > limits.pressure_max_kpa + tolerance_kpa ||
         pressure_kpa < limits.pressure_min_kpa - tolerance_kpa;
}

std::string beyond_text(const rig::RigFile& rig, std::size_t channel, double pressure_kpa) {
  const control::LimitSettings& limits = rig.settings.channels[channel].limits;
  return fmt::format("{:.4g} kPa; the limits are {:g} to {:g} kPa", pressure_kpa, limits.pressure_min_kpa,
                     limits.pressure_max_kpa);
}

std::optional<std::string> refusal_of(const rig::RigFile& rig, std::size_t channel,
                                      const ManometerReading& reading) {
  const control::ChannelSettings& of = rig.settings.channels[channel];
  const std::string causes =
      ". Either the points of the valve in the rig file are wrong, or the manometer reading is wrong";
  if (pressure_beyond(rig, channel, reading.shown_kpa)) {
    return fmt::format("the manometer of `{}` shows {}{}", of.name,
                       beyond_text(rig, channel, reading.shown_kpa), causes);
  }
  const double rest_kpa = control::resting_kpa(of.limits);
  const double step_kpa = reading.command_kpa - rest_kpa;
  if (std::abs(step_kpa) < least_tolerance_kpa) return std::nullopt;
  const double shown_kpa = std::max(std::abs(reading.shown_kpa - rest_kpa) - least_tolerance_kpa, 0.0);
  const double next_kpa = rest_kpa + shown_kpa / std::abs(step_kpa) * (reading.next_kpa - rest_kpa);
  if (!pressure_beyond(rig, channel, next_kpa)) return std::nullopt;
  return fmt::format(
      "the manometer of `{}` shows {:.4g} kPa at a command of {:.4g} kPa, so a command of {:.4g} kPa would "
      "give about {}{}. Correct the points, or choose lower pressures with --at-kpa",
      of.name, reading.shown_kpa, reading.command_kpa, reading.next_kpa, beyond_text(rig, channel, next_kpa),
      causes);
}

}  // namespace softgrip::tools
