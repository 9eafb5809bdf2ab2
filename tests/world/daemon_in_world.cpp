#include "tests/world/daemon_in_world.h"

#include <algorithm>
#include <csignal>
#include <utility>

#include "daemon/loop/thread.h"
#include "daemon/service/daemon_parts.h"

namespace softgrip::world {
namespace {

using control::Request;

using daemon::shutdown_deadline;

constexpr Nanoseconds look_pause = ns_per_s / 20;
constexpr Nanoseconds service_pause = ns_per_s / 50;
constexpr Nanoseconds heartbeat_patience = ns_per_s / 2;
/// Longest permitted interval between two heartbeats of the daemon. Equals WatchdogSec in the systemd unit.
constexpr Nanoseconds manager_patience = 2 * ns_per_s;
/// Longest time for which a run of one sequence waits until the rig is idle.
constexpr Nanoseconds one_shot_patience = 10 * ns_per_s;

daemon::Provenance provenance_of(const rig::RigFile& rig) {
  daemon::Provenance provenance;
  provenance.rig = rig.name;
  for (const control::ChannelSettings& channel : rig.settings.channels)
    provenance.channel_names.push_back(channel.name);
  provenance.rate_hz = rig.settings.rate_hz;
  provenance.decimation = rig.recorder.decimation;
  return provenance;
}

}  // namespace

DaemonInWorld::DaemonInWorld(const rig::RigFile& rig_file, Scheduler& scheduler, drivers::Board& board,
                             Life life)
    : rig(rig_file),
      clock(scheduler),
      bus_clock(scheduler),
      loop_clock(scheduler),
      origin(scheduler.shown()),
      controller(rig.settings),
      shared(1 << 14),
      events(10'000),
      provenance(provenance_of(rig)),
      loop(controller, rig.recorder.decimation, loop_clock, shared, loop_statistics),
      bus(board, rig.settings, rig.loop, rig.reconnect, bus_clock, shared, bus_statistics),
      recorder((rig.recorder.directory = std::move(life.folder), rig.recorder), provenance,
               life.record_folder, origin, shared, events, sequence_store),
      service(provenance.channel_names, origin, shared, events, sequence_store),
      scheduler_(scheduler) {
  if (life.sequence) one_shot_run.emplace(std::move(life.sequence), one_shot_patience);
  if (life.loader) {
    socket.emplace(daemon::StatusSources{rig.settings, provenance, service, recorder, loop_statistics,
                                         bus_statistics, rig.name, origin, nullptr, nullptr, &shared},
                   rig.socket, std::move(life.loader), events);
  }
  actors_.resize(part_count);
  actors_[static_cast<std::size_t>(Part::main)] = scheduler_.add("main", [this] { main_body(); });
}

bool DaemonInWorld::owns(ActorId id) const {
  return std::find(actors_.begin(), actors_.end(), id) != actors_.end();
}

void DaemonInWorld::kill() {
  for (const ActorId actor : actors_) scheduler_.kill(actor);
  ended_ = true;
}

void DaemonInWorld::main_body() {
  bus.open();
  const Nanoseconds start = clock.now() + ns_per_s / 100;
  const Nanoseconds period = nanoseconds(1 / rig.settings.rate_hz);
  const auto offset = static_cast<Nanoseconds>(rig.loop.bus_offset_fraction * static_cast<double>(period));
  const auto begin = [&](Part part, std::function<void()> body) {
    actors_[static_cast<std::size_t>(part)] = scheduler_.add("", std::move(body));
  };
  begin(Part::loop, [this, start, period] {
    loop.run(PeriodicSchedule(start, period));
    loop_done_ = true;
  });
  begin(Part::bus, [this, start, period, offset] {
    bus.run(PeriodicSchedule(start + offset, period), std::chrono::nanoseconds(shutdown_deadline));
    bus_done_ = true;
  });
  begin(Part::service, [this] { service_body(); });
  begin(Part::recorder, [this] { recorder_body(); });
  look_after();

  shared.shutdown_requested.store(true);
  const Nanoseconds give_up =
      clock.now() + shutdown_deadline + ns_per_s + rig.reconnect.connect_deadline.count();
  while (!(loop_done_ && bus_done_) && clock.now() < give_up)
    clock.sleep_until(clock.now() + ns_per_s / 1000);
  stop_others_ = true;
  for (const Part part : {Part::service, Part::recorder}) {
    while (!scheduler_.done(actor(part))) clock.sleep_until(clock.now() + ns_per_s / 1000);
  }
  // A stalled thread cannot be joined. Therefore the process ends without waiting for the loop and the bus
  // thread.
  for (const Part part : {Part::loop, Part::bus}) scheduler_.kill(actor(part));
  ended_ = true;
}

void DaemonInWorld::look_after() {
  const Nanoseconds pause = nanoseconds(1 / rig.settings.rate_hz) + heartbeat_patience;
  daemon::Heartbeat heartbeat(
      {pause, pause + std::max<Nanoseconds>(rig.reconnect.connect_deadline.count(),
                                            nanoseconds(rig.loop.exchange_deadline_s))});
  Nanoseconds beat = clock.now();
  while (!over()) {
    clock.sleep_until(clock.now() + look_pause);
    const Nanoseconds now = clock.now();
    if (heartbeat.beats(now, {loop_statistics.ticks.value(), bus_statistics.steps.value()})) beat = now;
    if (now - beat > manager_patience) starved_ = true;
  }
}

void DaemonInWorld::service_body() {
  while (!stop_others_) {
    serve();
    if (one_shot_run) one_shot_run->step(service, clock.now());
    if (socket) socket->serve(clock.now());
    clock.sleep_until(clock.now() + service_pause);
  }
  service.pump();
}

void DaemonInWorld::serve() {
  service.pump();
  for (auto request = requests_.begin(); request != requests_.end();) {
    const auto id = service.submit(request->kind, request->sequence);
    if (!id) {  // the service is busy with another request, so the client repeats this request later
      ++request;
      continue;
    }
    on_submit(request->kind, *id);
    // While this request is pending, the service refuses other requests as busy.
    unanswered_[*id] = {request->kind, scheduler_.now()};
    request = requests_.erase(request);
  }
  for (auto asked = unanswered_.begin(); asked != unanswered_.end();) {
    const bool open = service.take_reply(asked->first).kind == daemon::Service::Reply::Kind::pending;
    asked = open ? std::next(asked) : unanswered_.erase(asked);
  }
}

void DaemonInWorld::recorder_body() {
  while (!stop_others_) {
    recorder.drain();
    clock.sleep_until(clock.now() + nanoseconds(rig.recorder.flush_interval_s));
  }
  recorder.finish();
}

daemon::Outcome DaemonInWorld::outcome() {
  daemon::Outcome outcome;
  outcome.last = service.snapshot();
  outcome.channel_names = provenance.channel_names;
  outcome.safe_state_confirmed = safe_state_confirmed();
  if (asked_to_end_) outcome.signal = SIGINT;
  if (one_shot_run) daemon::conclude_one_shot_run(*one_shot_run, outcome);
  return outcome;
}

void DaemonInWorld::ask(Request::Kind kind, std::shared_ptr<const daemon::LoadedSequence> sequence) {
  requests_.push_back({kind, std::move(sequence), scheduler_.now()});
  if (actors_[static_cast<std::size_t>(Part::service)] != 0) scheduler_.wake(actor(Part::service));
}

}  // namespace softgrip::world
