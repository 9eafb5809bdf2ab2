#pragma once
// The control loop: waits for the next tick, reads, computes the commands, sends them and records them.

#include <cstddef>
#include <cstdint>

#include "base/clock.h"
#include "base/periodic_schedule.h"
#include "control/tick/tick.h"
#include "daemon/loop/shared_state.h"
#include "daemon/loop/statistics.h"

namespace softgrip::control {
class RigController;
}

namespace softgrip::daemon {

/// The control loop. Its functions do not allocate memory, lock, log or throw. They call the kernel for two
/// purposes: to read the clock and to sleep.
class Loop {
 public:
  /// Records a row in every `decimation`-th tick (>= 1). All referenced objects must exist longer than the
  /// loop.
  Loop(control::RigController& controller, std::uint32_t decimation, const Clock& clock, SharedState& shared,
       LoopStatistics& statistics) noexcept;

  /// Executes ticks on the schedule until shared.shutdown_requested is set, then calls leave().
  void run(PeriodicSchedule schedule) noexcept;

  /// Executes a tick that was due at the time `due`. A caller that does not use run() calls this function for
  /// each tick.
  void tick(Nanoseconds due) noexcept;

  /// Sends the safe outputs of the present phase, marks them as the last commands, and records them.
  void leave() noexcept;

 private:
  void read(control::TickInput& input) noexcept;
  [[nodiscard]] bool inputs_lost(Nanoseconds now) const noexcept;
  void command(bool last) noexcept;
  void tell_events() noexcept;
  void record_rows(bool last) noexcept;
  void show(const control::BusHealth& bus) noexcept;
  void count_overruns(std::uint64_t skipped, bool woken_late) noexcept;

  control::RigController& controller_;
  const Clock& clock_;
  SharedState& shared_;
  LoopStatistics& statistics_;
  const control::TickOutput& output_;  // output of the controller in the last tick
  std::size_t channels_;
  std::uint32_t decimation_;
  std::uint64_t ticks_ = 0;
  std::uint32_t unreported_ = 0;      // number of ticks since the last report of the bus
  std::uint32_t inhibit_ = 0;         // newest value of BusHealth::inhibit that the bus has reported
  std::uint32_t overrun_cycles_ = 0;  // number of cycles that were missed just before the next tick
  Nanoseconds woken_ = 0;
  Nanoseconds ended_ = 0;
};

}  // namespace softgrip::daemon
