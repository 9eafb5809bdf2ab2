#pragma once
// The feedforward classes. Their settings are in control/elements/feedforward.h.

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
  bool out_of_reach = false;  ///< the reference exceeds the limits; the pressure goes as far as the limits
                              ///< allow
};

/// Inputs of a feedforward. The reference is in mm of the finger. `offset_mm` is the reading minus the model.
struct FeedforwardQuery {
  const Reference* reference = nullptr;
  double time_s = 0;  ///< now, on the reference's clock
  double offset_mm = 0;
  const PressurePlan* plan = nullptr;  ///< plan for the kind `planned`
  double plan_origin_s = 0;            ///< origin of the plan's clock on the reference's clock
};

// Each kind has three functions. enter() is called with the present outputs when tracking begins. step() is
// called once per tick after that. preview_s() returns the time by which the kind reads the reference ahead.
// A new kind needs a class and an entry in the variant of Feedforward.

class NoFeedforward {
 public:
  void enter(const RunningModel&, const FeedforwardQuery&, double) noexcept {}
  FeedforwardStep step(const FeedforwardQuery&) noexcept { return {}; }
  [[nodiscard]] double preview_s() const noexcept { return 0; }
};

/// The published scheme, which returns the pressure at which the Bouc-Wen element alone would follow the
/// reference. The PID corrects the effect of the other elements of the finger, of the valve and of all
/// delays.
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

/// Inverse of the complete chain, computed from the finger back to the valve. The pressure at the actuator is
/// planned ahead. Each tick adds one pressure to this plan: the pressure at which the chain after the valve
/// reaches the reference at the time "now + one tick + all dead times", provided that the plan was followed
/// so far. The command follows from the plan (ValveInverse).
///
/// The lead differentiates the plan, which contains no sensor noise. The command stays inside the pressure
/// range and the slew limits. The plan is the effect of the limited command, so it does not wind up. If the
/// reference is out of reach, the plan goes as far as the limits allow, step() reports it, and the plan
/// continues from there. Behind a lag, a slewing command cannot stop the pressure at once. The plan then
/// approaches the reference no faster than it can brake (constant deceleration slew/tau), so a jump of the
/// reference causes no ringing.
class FullModelFeedforward {
 public:
  FullModelFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                       const LimitSettings& limits, double tick_s);
  /// Starts from the state of the running model. At that moment the model's free response and the reference
  /// differ because of creep or an offset of the reading. The difference fades out without a jump.
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
  double ceiling_kpa_;  ///< highest pressure that passes the model's valve
  ValveInverse valve_;
  double preview_s_;
  ActuatorInverse inverse_;
  double command_kpa_ = 0;                  ///< command of the last tick
  double last_wanted_kpa_ = 0;              ///< the pressure that the reference needed in the last tick
  double easy_mm_per_s2_;                   ///< acceleration of the finger within the slew limits
  double easy_mm_per_s_;                    ///< speed of the finger within the slew limits
  std::array<double, 2> last_target_mm_{};  ///< targets of the last two ticks, newest first
  double last_displacement_mm_ = 0;         ///< displacement of the plan one tick earlier
  Reference fade_;  ///< fade-out of the difference after enter() or a jump of the reference, on the
                    ///< reference's clock
};

/// Follows a plan that was computed before the run (control/sequences/planner.h). The plan is read ahead by
/// the total dead time, and by half a tick because the board holds its output for a tick. The plan does not
/// include the offset of a finger from its model (offset_mm). The offset divided by the settled gain is added
/// to the planned pressure. If there is no plan, or if the reference starts more than 1 mm from the plan, the
/// pressure is computed from the reference with the settled gain alone until the next step. After each change
/// between these sources, the difference from the previous pressure fades out over 3 s. The PID corrects the
/// remaining error.
class PlannedFeedforward {
 public:
  PlannedFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                     const LimitSettings& limits, double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  /// Returns more than the dead time, because a plan acts before its reference changes.
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
  double difference_kpa_ = 0;  ///< difference between the previous pressure and the first pressure of the new
                               ///< source
  double fade_left_s_ = 0;     ///< remaining time of the fade-out
  bool entering_ = true;
};

/// Returns the time by which a plan is read ahead of now: all dead time and half a tick [s].
[[nodiscard]] double plan_ahead_s(const model::Model& model, const FeedforwardSettings& settings,
                                  double tick_s);

/// A feedforward of any kind.
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
