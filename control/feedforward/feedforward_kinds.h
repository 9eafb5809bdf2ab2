#pragma once
// Defines one class for each kind of feedforward. The settings of the kinds are in
// control/elements/feedforward.h.

#include <variant>

#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "control/feedforward/actuator_inverse.h"
#include "control/feedforward/jump_detector.h"
#include "control/feedforward/pressure_plan.h"
#include "control/feedforward/running_model.h"
#include "control/feedforward/valve_inverse.h"
#include "model/model.h"

namespace softgrip::control {

/// Result of a feedforward in one tick.
struct FeedforwardStep {
  double pressure_kpa = 0;
  bool out_of_reach = false;  ///< true: the reference cannot be reached within the limits, so the pressure
                              ///< goes as far as the limits allow
};

/// Inputs of a feedforward. `reference` is the displacement of the finger in mm, and `offset_mm` is the
/// reading minus the model output.
struct FeedforwardQuery {
  const Reference* reference = nullptr;
  double time_s = 0;  ///< present time on the clock of the reference
  double offset_mm = 0;
  const PressurePlan* plan = nullptr;  ///< plan for the feedforward `planned`; nullptr if there is none
  double plan_origin_s = 0;            ///< time on the clock of the reference at which the clock of the plan
                                       ///< is 0
};

// Each kind of feedforward has three functions. enter() is called with the present outputs when tracking of a
// reference begins. step() is called once per tick after enter(). preview_s() returns how far ahead of now
// the kind reads the reference. A new kind needs a class, an entry in the variant of Feedforward, and a case
// in the constructor of Feedforward. A kind with a state that changes while the command is constant also
// needs the function hold() and a call of this function in Feedforward::hold().

class NoFeedforward {
 public:
  void enter(const RunningModel&, const FeedforwardQuery&, double) noexcept {}
  FeedforwardStep step(const FeedforwardQuery&) noexcept { return {}; }
  [[nodiscard]] double preview_s() const noexcept { return 0; }
};

/// Implements the scheme of Zhang et al. 2025: computes the pressure for which the Bouc-Wen element follows
/// the reference as if it were the whole finger. The PID corrects the effect of the other elements of the
/// finger, of the valve and of all delays.
class BoucWenFeedforward {
 public:
  BoucWenFeedforward(const model::Model& model, const LimitSettings& limits, double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  [[nodiscard]] double preview_s() const noexcept { return 0; }

 private:
  LimitSettings limits_;
  ActuatorInverse inverse_;
};

/// Inverse of the complete chain, computed from the finger back to the valve. Each tick appends one pressure
/// at the actuator to a plan. With this pressure, the chain after the valve reaches the reference at the time
/// "now + one tick + all dead times". ValveInverse computes the command from the plan.
///
/// Noise: the lead differentiates the planned pressure, which contains no sensor noise.
///
/// Limits: the command stays inside the pressure range and the slew limits. The plan is computed from the
/// limited command, so the plan does not wind up. If the limits prevent the finger from reaching the
/// reference, step() reports this. The next tick continues the plan from the pressure that was reached.
///
/// Braking: after a lag with the time constant tau, the pressure cannot stop at once, because the slew rate
/// of the command is limited. The plan therefore approaches the reference only so fast that the constant
/// deceleration slew/tau can stop the pressure. As a result, a jump of the reference causes no ringing.
class FullModelFeedforward {
 public:
  FullModelFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                       const LimitSettings& limits, double tick_s);
  /// Starts from the state of the running model. At the start, the displacement of the model can differ from
  /// the reference because of creep or an offset of the reading. This difference fades out without a jump of
  /// the command.
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  void hold() noexcept;
  [[nodiscard]] double preview_s() const noexcept { return preview_s_; }

 private:
  [[nodiscard]] ReferencePoint target(const FeedforwardQuery& query) const noexcept;
  void fade_from(double displacement_mm, double speed_mm_per_s, const ReferencePoint& to,
                 double then_s) noexcept;
  [[nodiscard]] double command_toward(double wanted_kpa) noexcept;
  /// Advances the states of valve and finger by one tick under the command `command_kpa_`.
  void advance() noexcept;

  LimitSettings limits_;
  double tick_s_;
  double ceiling_kpa_;  ///< highest pressure that the model's valve can output
  ValveInverse valve_;
  double preview_s_;
  ActuatorInverse inverse_;
  double command_kpa_ = 0;      ///< pressure command of the last tick
  double last_wanted_kpa_ = 0;  ///< pressure that was needed for the reference in the last tick
  double easy_mm_per_s2_;       ///< acceleration of the finger while the command changes at the slew limit
  double easy_mm_per_s_;        ///< speed at which the finger moves while the command changes at the slew
                                ///< limit
  JumpDetector jumps_;          ///< jumps of the target displacement
  double last_displacement_mm_ = 0;  ///< displacement of the model at the start of the previous tick
  bool held_ = false;  ///< true: the command was held in the last tick, so the next step starts a fade-out
  Reference fade_;     ///< fade-out of the difference after enter(), after hold() or after a jump of the
                       ///< reference, on the clock of the reference
};

/// Follows a plan that was computed before the sequence starts (control/sequences/planner.h). The plan is
/// read ahead by the total dead time, plus half a tick because the board holds its output for a tick. The
/// plan does not include offset_mm, the offset of the finger from its model. Therefore, the difference in
/// displacement divided by the settled gain is added to the planned pressure. Without a plan, or if the
/// reference starts more than 1 mm from its plan, the pressure is computed from the reference and the settled
/// gain. This continues until the next step of the sequence. A change between plan and settled gain causes a
/// pressure difference, which fades out over 3 s. The PID corrects the remaining error.
class PlannedFeedforward {
 public:
  PlannedFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                     const LimitSettings& limits, double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  /// Returns the preview [s]: how far ahead of the present time the reference must be known. The preview is
  /// longer than the dead time, because a plan starts to change the command before the reference changes.
  [[nodiscard]] double preview_s() const noexcept { return ahead_s_ + plan_lead_s; }

 private:
  [[nodiscard]] double unplanned_mm(const FeedforwardQuery& query, double wanted_mm,
                                    double then_s) const noexcept;

  LimitSettings limits_;
  SettledLine settled_;
  double tick_s_;
  double ahead_s_;
  const PressurePlan* plan_ = nullptr;
  double origin_s_ = 0;
  bool on_plan_ = false;
  double last_kpa_ = 0;
  double difference_kpa_ = 0;  ///< difference between the last pressure of the previous source (plan or
                               ///< settled gain) and the first pressure of the new source
  double fade_left_s_ = 0;     ///< remaining time of the fade-out of difference_kpa_
  bool entering_ = true;
};

/// Returns how far ahead of now a plan is read: the sum of the model's dead times, extra_latency_s and half a
/// tick [s].
[[nodiscard]] double plan_ahead_s(const model::Model& model, const FeedforwardSettings& settings,
                                  double tick_s);

/// A feedforward of the kind that the settings select.
class Feedforward {
 public:
  Feedforward(const model::Model& model, const FeedforwardSettings& settings, const LimitSettings& limits,
              double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  /// Replaces step() in a tick without a reference. The board continues to hold the command of the last
  /// step() or enter(), within the pressure range. The finger still moves in this tick, because the valve
  /// lags and the finger creeps. The state of the kind `full_model` follows this motion. The next step()
  /// starts a fade-out from this motion to the reference. The other kinds do not change: the state of
  /// `bouc_wen` is constant at a constant pressure, and `planned` gets a reference in every tick.
  void hold() noexcept;
  [[nodiscard]] double preview_s() const noexcept;

 private:
  std::variant<NoFeedforward, BoucWenFeedforward, FullModelFeedforward, PlannedFeedforward> kind_;
};

}  // namespace softgrip::control
