#pragma once
// Computes the commands of one tick from the readings of this tick. The control loop calls this class, and
// the class calls the rest of control/. The programs softgripd and `softgrip run`, simulations in virtual
// time, tests and benchmarks use this class.

#include <vector>

#include "control/tick/rig_channel.h"
#include "control/tick/rig_conditions.h"
#include "control/tick/sequence_player.h"
#include "control/tick/settings.h"
#include "control/tick/supervisor.h"
#include "control/tick/tick.h"

namespace softgrip::control {

/// The controller of a rig. The constructor may allocate memory. The constructor throws no other exception
/// than std::bad_alloc, because settings_problems() has checked the settings. tick() does not allocate
/// memory, does not call the operating system, and cannot fail.
class RigController {
 public:
  explicit RigController(const RigSettings& settings);
  // The control loop refers to the output inside this object, so the object must not be copied.
  RigController(const RigController&) = delete;
  RigController& operator=(const RigController&) = delete;

  /// Executes one tick in four stages: conditions, supervisor, player, channels. Ticks follow each other at
  /// intervals of 1/settings.rate_hz. Returns output().
  const TickOutput& tick(const TickInput& input) noexcept;

  /// Returns the output of the last tick. Before the first tick, the commands are the rest pressures.
  [[nodiscard]] const TickOutput& output() const noexcept { return output_; }

 private:
  void control(const TickInput& input, const RigDecision& decision) noexcept;

  RigConditions conditions_;
  Supervisor supervisor_;
  SequencePlayer player_;
  std::vector<RigChannel> channels_;
  TickOutput output_;
  Nanoseconds began_ = no_tick;

  static constexpr Nanoseconds no_tick = -1;
};

}  // namespace softgrip::control
