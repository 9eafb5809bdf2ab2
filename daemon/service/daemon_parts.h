#pragma once
// The parts of Daemon that real time and virtual time have in common.

#include <memory>
#include <optional>
#include <string>

#include "base/clock.h"
#include "control/tick/rig_controller.h"
#include "daemon/loop/bus.h"
#include "daemon/loop/loop.h"
#include "daemon/recording/recorder.h"
#include "daemon/recording/run_json.h"
#include "daemon/service/daemon.h"
#include "daemon/service/signals.h"
#include "daemon/socket/service.h"

namespace softgrip::daemon {

/// Longest time until the board must have confirmed the last outputs [ns].
inline constexpr Nanoseconds shutdown_deadline = ns_per_s;

struct DaemonParts {
  DaemonParts(rig::RigFile rig_file, DaemonOptions run_options);

  /// Returns the time between two ticks [ns].
  [[nodiscard]] Nanoseconds period() const noexcept;
  /// Returns the time from a tick to the exchange that follows the tick [ns].
  [[nodiscard]] Nanoseconds bus_offset() const noexcept;
  /// Passes new events to options.on_event.
  void deliver_events();
  /// Completes `outcome` at the end of a run, from the present state of the rig.
  void conclude(Outcome& outcome);
  void tell(const char* kind, Severity severity, std::string text);

  rig::RigFile rig;
  DaemonOptions options;
  Provenance provenance;
  MonotonicClock system_clock;
  VirtualClock virtual_clock;
  const Clock& clock;
  Nanoseconds origin;  // clock time that counts as 0 in the event log
  std::unique_ptr<drivers::Board> board;
  std::string board_text;
  control::RigController controller;
  SharedState shared;
  EventLog events;
  SequenceStore sequence_store;
  std::shared_ptr<const SequenceLoader> loader;
  LoopStatistics loop_statistics;
  BusStatistics bus_statistics;
  Loop loop;
  Bus bus;
  Recorder recorder;
  Service service;
  std::optional<OneShotRun> one_shot_run;
  std::uint64_t delivered = 0;  // id of the last event that was passed to on_event
};

/// Updates `outcome` from the present state of the one-shot run. The one-shot run may still be active.
void conclude_one_shot_run(const OneShotRun& one_shot_run, Outcome& outcome);

/// Executes ticks as fast as possible in the calling thread, without other threads.
[[nodiscard]] Outcome run_in_virtual_time(DaemonParts& parts, Signals& signals);
/// Executes ticks at the times of the clock, with several threads.
[[nodiscard]] Outcome run_in_real_time(DaemonParts& parts, Signals& signals);

}  // namespace softgrip::daemon
