#pragma once
// The feedforwards themselves; their settings are in control/feedforward.h.

#include <variant>

#include "control/actuator_inverse.h"
#include "control/feedforward.h"
#include "control/limits.h"
#include "control/reference.h"
#include "control/running_model.h"
#include "model/model.h"

namespace softgrip::control {

/// What a feedforward gave in a tick.
struct FeedforwardStep {
  double pressure_kpa = 0;
  bool out_of_reach = false;  ///< the reference needs more than the limits allow; it goes as far as they do
};

/// What a feedforward is asked with. The reference is in mm of the finger; `offset_mm` is what the finger
/// shows more than the model.
struct FeedforwardQuery {
  const Reference* reference = nullptr;
  double time_s = 0;  ///< now, on the reference's clock
  double offset_mm = 0;
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
/// now, the last tick's plan being the truth so far. From the plan follows the command:
///
///   behind a lag:  u = p[k-1] + (p[k] - p[k-1]) / (1 - exp(-T/tau)), held for the tick: the exact inverse of
///                  a first-order lag under a held input, so lead and the hold's half sample are one;
///   without one:   u = (p[k-1] + p[k]) / 2, the middle of the stretch, for the same half sample.
///
/// The derivative in the lead is one of the plan, which carries no sensor noise. The plan stays inside what
/// a command inside the pressure range can do and moves no faster than the slew limits, so it does not wind
/// up: where the reference is out of reach it stays at the bound, says so, keeps the state that the bound
/// gives, and goes on from there. A corner of the reference makes the lead jump by tau times the change of
/// slope, which the limits' slew then rounds; the error that leaves fades with tau.
class FullModelFeedforward {
 public:
  FullModelFeedforward(const model::Model& model, const FeedforwardSettings& settings,
                       const LimitSettings& limits, double tick_s);
  /// Begins from where the running model stands. What the model would do by itself and the reference differ
  /// at that moment (creep, a reading off the model); the difference is faded out, not jumped over.
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  [[nodiscard]] double preview_s() const noexcept { return preview_s_; }

 private:
  struct Bracket {
    double lower_kpa, upper_kpa;
  };
  [[nodiscard]] ReferencePoint target(const FeedforwardQuery& query) const noexcept;
  [[nodiscard]] Bracket bracket() const noexcept;
  [[nodiscard]] double command_for(double pressure_kpa) const noexcept;

  LimitSettings limits_;
  double tick_s_;
  double ceiling_kpa_;  ///< highest pressure that the model's valve lets through
  double lag_s_;
  double lag_share_;  ///< of the way to the command that the lag goes in a tick; 1 without a lag
  double preview_s_;
  ActuatorInverse inverse_;
  Reference fade_;  ///< of the difference at enter(), on the reference's clock
};

/// One of them.
class Feedforward {
 public:
  Feedforward(const model::Model& model, const FeedforwardSettings& settings, const LimitSettings& limits,
              double tick_s);
  void enter(const RunningModel& running, const FeedforwardQuery& query, double command_kpa) noexcept;
  FeedforwardStep step(const FeedforwardQuery& query) noexcept;
  [[nodiscard]] double preview_s() const noexcept;

 private:
  std::variant<NoFeedforward, BoucWenFeedforward, FullModelFeedforward> kind_;
};

}  // namespace softgrip::control
