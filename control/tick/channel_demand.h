#pragma once
// Defines what the sequence player or the supervisor demands of one channel in one tick.

#include <cstdint>
#include <limits>

#include "control/elements/reference.h"
#include "control/feedforward/pressure_plan.h"

namespace softgrip::control {

/// The mode may change in each tick; the command does not jump at such a change.
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
  /// so the finger does not press harder and harder against a stiff object. The feedforward continues.
  bool feedback_held = false;
  /// Upper bounds of the step for the command. They apply in every mode: the command never exceeds either of
  /// them.
  double pressure_max_kpa = std::numeric_limits<double>::infinity();
  /// Upper bound of the gripping pressure. Gripping pressure is the pressure above the command under which
  /// the free finger rests at the present displacement.
  double squeeze_max_kpa = std::numeric_limits<double>::infinity();
};

}  // namespace softgrip::control
