#pragma once
// Defines the input of a channel from the sequence player or the supervisor in one tick.

#include <cstdint>
#include <limits>

#include "control/elements/reference.h"
#include "control/feedforward/pressure_plan.h"

namespace softgrip::control {

/// The demand on one channel in one tick. The mode may change in each tick; the command does not jump at a
/// change of the mode.
struct ChannelDemand {
  enum class Mode : std::uint8_t {
    hold,          ///< the pressure command does not change
    vent,          ///< the command goes to the rest pressure at the slew limit
    pressure,      ///< the command is `pressure_kpa`, within the limits; no feedback
    displacement,  ///< feedforward and feedback follow `reference`
  };
  Mode mode = Mode::hold;
  double pressure_kpa = 0;               ///< requested pressure in mode pressure
  const Reference* reference = nullptr;  ///< reference in mode displacement [mm]; its times are on the clock
                                         ///< of `time_s`
  double time_s = 0;                     ///< present time on the clock of the reference
  /// Plan for the reference in mode displacement, if the feedforward is `planned`; nullptr if there is no
  /// plan. The time in the plan is the time on the reference's clock minus plan_origin_s.
  const PressurePlan* plan = nullptr;
  double plan_origin_s = 0;
  /// True in mode displacement if the finger is in contact with an object. The feedback then keeps its value,
  /// so that a growing integral does not press the finger harder and harder against a stiff object. The
  /// feedforward continues to follow the reference.
  bool feedback_held = false;
  /// Largest command that the step of the sequence permits [kPa]. The bound applies in every mode, as
  /// squeeze_max_kpa does.
  double pressure_max_kpa = std::numeric_limits<double>::infinity();
  /// Upper bound of the gripping pressure [kPa]. The gripping pressure is the command minus the command under
  /// which the free finger rests at the present displacement.
  double squeeze_max_kpa = std::numeric_limits<double>::infinity();
};

}  // namespace softgrip::control
