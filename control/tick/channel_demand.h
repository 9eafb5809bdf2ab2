#pragma once
// Defines the demand of the sequence player or the supervisor for one channel in one tick.

#include <cstdint>
#include <limits>

#include "control/elements/reference.h"
#include "control/feedforward/pressure_plan.h"

namespace softgrip::control {

/// Modes can change from any to any at any tick; the command stays continuous.
struct ChannelDemand {
  enum class Mode : std::uint8_t {
    hold,          ///< the command stays where it is
    vent,          ///< to the rest pressure, at the slew limit
    pressure,      ///< the command is `pressure_kpa`, within the limits; no feedback
    displacement,  ///< feedforward and feedback follow `reference`
  };
  Mode mode = Mode::hold;
  double pressure_kpa = 0;               ///< of pressure
  const Reference* reference = nullptr;  ///< of displacement [mm]; on the clock of `time_s`
  double time_s = 0;                     ///< now, on that clock
  /// Of displacement with feedforward `planned`: the plan for the reference; nullptr where there is none. Its
  /// clock is that of `time_s` less plan_origin_s.
  const PressurePlan* plan = nullptr;
  double plan_origin_s = 0;
  /// In mode displacement: the finger is in contact with an object. The feedback keeps its value, so the
  /// finger does not press harder and harder against a stiff object. The feedforward continues.
  bool feedback_held = false;
  /// Bounds of the step in every mode. The command stays at or below both, regardless of the demand.
  double pressure_max_kpa = std::numeric_limits<double>::infinity();
  /// Relative to the command that the free finger needs to rest at the present displacement
  double squeeze_max_kpa = std::numeric_limits<double>::infinity();
};

}  // namespace softgrip::control
