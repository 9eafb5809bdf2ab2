#pragma once
// The feedforwards themselves; their settings are in control/elements/feedforward.h.

#include <array>
#include <variant>

#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "control/elements/reference.h"
#include "control/feedforward/actuator_inverse.h"
#include "control/feedforward/pressure_plan.h"
#include "control/feedforward/running_model.h"
#include "control/feedforward/valve_inverse.h"
#include "model/model.h"

namespace softgrip::control {

/// Result of a feedforward in one tick.
struct FeedforwardStep {
  double pressure_kpa = 0;
  bool out_of_reach = false;  ///< the reference needs more than the limits allow; it goes as far as they do
};

/// Inputs of a feedforward. The reference is in mm of the finger. `offset_mm` is the reading minus the model.
struct FeedforwardQuery {
  const Reference* reference = nullptr;
  double time_s = 0;  ///< now, on the reference's clock
  double offset_mm = 0;
  const PressurePlan* plan = nullptr;  ///< of `planned`
  double plan_origin_s = 0;            ///< of the plan's clock on the reference's
};

// Each kind has: enter() when tracking begins, with what is out there; step() once per tick from then on;
// preview_s(), how far ahead it asks the reference. A further kind is one more class and one more line in
// Feedforward.

class NoFeedforward {
 public:
  void enter(const RunningModel&, const FeedforwardQuery&, double) noexcept {}
  FeedforwardStep step(const FeedforwardQuery&) noexcept { return {}; }
  [[nodiscard]] double preview_s() const noexcept { return 0; }
};

/// The published scheme: the pressure at which the Bouc-Wen element alone would give the reference. The rest
/// of the finger, the valve and all delays are left to the PID.
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

/// The whole chain undone from right to left. The pressure at the actuator is planned ahead: each tick adds
/// the pressure at which everything behind the valve reaches the reference one tick plus all dead time from
/// now, the plan so far being the truth. From the plan follows the command (ValveInverse).
///
/// The derivative in the lead is one of the plan, which carries no sensor noise. The command stays inside the
/// pressure range and the slew limits, and the plan is what such a command does, so it does not wind up:
/// where the reference is out of reach the plan goes as far as it can, says so, and goes on from there.
/// Behind a lag a command that must slew cannot stop the pressure at once; the plan then nears the reference
/// no faster than it can brake (constant deceleration slew/tau), so that a jump is reached without ringing.
class FullModelFeedforward {
 public:
  FullModelFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                       const LimitSettings& limits, double tick_s);
  /// Starts from the state of the running model. At that moment the model's free response and the reference
  /// differ (creep, an offset of the reading). The difference fades out without a jump.
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  [[nodiscard]] double preview_s() const noexcept { return preview_s_; }

 private:
  [[nodiscard]] ReferencePoint target(const FeedforwardQuery& query) const noexcept;
  void fade_from(double displacement_mm, double speed_mm_per_s, const ReferencePoint& to,
                 double then_s) noexcept;
  [[nodiscard]] double command_toward(double wanted_kpa) noexcept;

  LimitSettings limits_;
  double tick_s_;
  double ceiling_kpa_;  ///< highest pressure that the model's valve lets through
  ValveInverse valve_;
  double preview_s_;
  ActuatorInverse inverse_;
  double command_kpa_ = 0;                  ///< the last one
  double last_wanted_kpa_ = 0;              ///< the pressure that the reference needed in the last tick
  double easy_mm_per_s2_;                   ///< acceleration of the finger that the slew limits pass
  double easy_mm_per_s_;                    ///< speed of the finger that they pass
  std::array<double, 2> last_target_mm_{};  ///< newest first
  double last_displacement_mm_ = 0;         ///< of the plan, one tick before
  Reference fade_;  ///< of the difference after enter() or a jump, on the reference's clock
};

/// A plan from before the run (control/sequences/planner.h), read ahead by the total dead time and half a
/// tick for the hold. The plan does not include the offset of a finger from its model (offset_mm); the
/// settled gain adds it. If there is no plan, or the reference starts more than 1 mm from the plan, the
/// settled gain alone follows the reference until the next step. After each change of the source, the
/// difference to the previous pressure fades out over 3 s. The PID corrects the rest.
class PlannedFeedforward {
 public:
  PlannedFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                     const LimitSettings& limits, double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  /// More than the dead time: a plan acts before its reference does.
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
  double difference_kpa_ = 0;  ///< between where the pressure was and where the source began
  double fade_left_s_ = 0;     ///< until it is gone
  bool entering_ = true;
};

/// How far ahead of now a plan is read: all dead time and half a tick [s].
[[nodiscard]] double plan_ahead_s(const model::Model& model, const FeedforwardSettings& settings,
                                  double tick_s);

/// One of them.
class Feedforward {
 public:
  Feedforward(const model::Model& model, const FeedforwardSettings& settings, const LimitSettings& limits,
              double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  [[nodiscard]] double preview_s() const noexcept;

 private:
  std::variant<NoFeedforward, BoucWenFeedforward, FullModelFeedforward, PlannedFeedforward> kind_;
};

}  // namespace softgrip::control
