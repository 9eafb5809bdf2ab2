#pragma once
// The parts of Daemon that runs in real time and runs in virtual time share.

#include <memory>
#include <optional>
#include <string>

#include "base/clock.h"
#include "control/tick/rig_controller.h"
#include "daemon/loop/bus.h"
#include "daemon/loop/loop.h"
#include "daemon/recording/provenance.h"
#include "daemon/recording/recorder.h"
#include "daemon/service/daemon.h"
#include "daemon/service/signals.h"
#include "daemon/socket/service.h"

namespace softgrip::daemon {

/// Longest time for the board to confirm the last outputs [ns].
inline constexpr Nanoseconds shutdown_deadline = ns_per_s;

struct DaemonParts {
  DaemonParts(rig::RigFile rig_file, DaemonOptions run_options);

  /// Returns the time between two ticks [ns].
  [[nodiscard]] Nanoseconds period() const noexcept;
  /// Returns the time from a tick to the following exchange [ns].
  [[nodiscard]] Nanoseconds bus_offset() const noexcept;
  /// Passes new events to options.on_event.
  void deliver_events();
  /// Updates the result of the run from the present state, if the sequence is over.
  void conclude(Outcome& outcome);
  void tell(const char* kind, Severity severity, std::string text);

  rig::RigFile rig;
  DaemonOptions options;
  Provenance provenance;
  MonotonicClock system_clock;
  VirtualClock virtual_clock;
  const Clock& clock;
  Nanoseconds origin;  // time 0 of the event log
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
  std::uint64_t delivered = 0;  // id of the last event passed to on_event
};

/// Updates the result from the one-shot run, which may have finished or not.
void conclude_one_shot_run(const OneShotRun& one_shot_run, Outcome& outcome);

/// Runs ticks as fast as possible in this thread only.
[[nodiscard]] Outcome run_in_virtual_time(DaemonParts& parts, Signals& signals);
/// Runs ticks by the clock, with threads.
[[nodiscard]] Outcome run_in_real_time(DaemonParts& parts, Signals& signals);

}  // namespace softgrip::daemon
