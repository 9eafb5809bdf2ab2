#pragma once
// Defines the demand of the sequence player or the supervisor for one channel in one tick.

#include <cstdint>
#include <limits>

#include "control/elements/reference.h"
#include "control/feedforward/pressure_plan.h"

namespace softgrip::control {

/// The mode may change in each tick; the command remains continuous.
struct ChannelDemand {
  enum class Mode : std::uint8_t {
    hold,          ///< the command does not change
    vent,          ///< the command goes to the rest pressure at the slew limit
    pressure,      ///< the command is `pressure_kpa`, within the limits; no feedback
    displacement,  ///< feedforward and feedback follow `reference`
  };
  Mode mode = Mode::hold;
  double pressure_kpa = 0;               ///< for mode pressure
  const Reference* reference = nullptr;  ///< for mode displacement [mm]; on the clock of `time_s`
  double time_s = 0;                     ///< present time on the clock of the reference
  /// For mode displacement with feedforward `planned`: the plan for the reference; nullptr without a plan.
  /// The time in the plan is the time on the reference's clock minus plan_origin_s.
  const PressurePlan* plan = nullptr;
  double plan_origin_s = 0;
  /// In mode displacement: the finger is in contact with an object. The feedback keeps its value, so the
  /// finger does not press harder and harder against a stiff object. The feedforward continues.
  bool feedback_held = false;
  /// Bounds of the step in every mode. The command stays at or below both, regardless of the demand.
  double pressure_max_kpa = std::numeric_limits<double>::infinity();
  /// Bound of the pressure above the command under which the free finger rests at the present displacement.
  double squeeze_max_kpa = std::numeric_limits<double>::infinity();
};

}  // namespace softgrip::control
