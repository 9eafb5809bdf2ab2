// Runs the daemon in virtual time, in one thread and without sleeping. Each run with the same seed has the
// same result.

#include "daemon/service/daemon.h"
#include "daemon/service/daemon_parts.h"

namespace softgrip::daemon {

namespace {

/// Number of ticks between two calls of look(). look() serves the recorder, the service and the events.
constexpr std::uint64_t ticks_per_look = 64;

void exchange(DaemonParts& parts, Nanoseconds due) {
  parts.virtual_clock.set(due);
  parts.bus.step(due);
}

void look(DaemonParts& parts, Nanoseconds now) {
  parts.service.pump();
  if (parts.one_shot_run) parts.one_shot_run->step(parts.service, now);
  parts.recorder.drain();
  parts.deliver_events();
}

}  // namespace

Outcome run_in_virtual_time(DaemonParts& parts, Signals& signals) {
  if (parts.options.on_start)
    parts.options.on_start(startup_report(parts.rig, *parts.board, nullptr, parts.options.program));
  const Nanoseconds began = parts.system_clock.now();
  const Nanoseconds period = parts.period();
  const Nanoseconds end =
      parts.options.duration_s ? parts.origin + nanoseconds(*parts.options.duration_s) : INT64_MAX - period;
  Nanoseconds due = parts.origin;
  for (std::uint64_t tick = 0; due < end; ++tick, due += period) {
    parts.virtual_clock.set(due);
    parts.loop.tick(due);
    exchange(parts, due + parts.bus_offset());
    if (tick % ticks_per_look != 0) continue;
    look(parts, due);
    if ((parts.one_shot_run && parts.one_shot_run->finished()) || signals.wait(0) != 0) {
      due += period;  // the last outputs get a tick of their own, so that no time occurs twice in a recording
      break;
    }
  }
  parts.virtual_clock.set(due);
  parts.loop.leave();
  for (const Nanoseconds give_up = due + shutdown_deadline;
       due < give_up && !parts.shared.safe_state_confirmed; due += period) {
    exchange(parts, due + parts.bus_offset());
  }
  look(parts, due);
  parts.recorder.finish();
  Outcome outcome;
  parts.conclude(outcome);
  outcome.wall_s = seconds(parts.system_clock.now() - began);
  parts.deliver_events();
  return outcome;
}

}  // namespace softgrip::daemon
