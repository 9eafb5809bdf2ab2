#pragma once
// Simulates one run of the daemon, from start to end, on the simulated clock. Loop, bus, service and recorder
// are the classes that run on a real rig. Their threads execute the same functions as in
// daemon/service/real_run.cpp.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/tick/rig_controller.h"
#include "daemon/loop/bus.h"
#include "daemon/loop/loop.h"
#include "daemon/recording/recorder.h"
#include "daemon/service/daemon.h"
#include "daemon/socket/one_shot_run.h"
#include "daemon/socket/service.h"
#include "rig/rig_file.h"
#include "tests/world/hardware.h"
#include "tests/world/scheduler.h"
#include "tests/world/socket_in_world.h"

namespace softgrip::world {

enum class Part : std::uint8_t { loop, bus, service, recorder, main };
inline constexpr std::size_t part_count = 5;

/// A request of a client to which the daemon has not responded yet.
struct Asked {
  control::Request::Kind kind = control::Request::Kind::none;
  Nanoseconds at = 0;
};

/// The clock of the loop. As on a real machine, any two readings of this clock differ. The row that the
/// recorder writes at shutdown therefore has another time than all other rows.
class LoopClock final : public WorldClock {
 public:
  using WorldClock::WorldClock;
  [[nodiscard]] Nanoseconds now() const noexcept override {
    const Nanoseconds seen = WorldClock::now();
    return last_ = seen > last_ ? seen : last_ + look_takes;
  }

 private:
  static constexpr Nanoseconds look_takes = 100;
  mutable Nanoseconds last_ = 0;
};

/// The settings in which two runs of the daemon can differ.
struct Life {
  std::string folder;         ///< folder for the recordings of this run
  std::string record_folder;  ///< folder of all recordings; empty: the folder in the rig file
  std::shared_ptr<const daemon::LoadedSequence>
      sequence;  ///< sequence after which the daemon ends, as in `softgrip run`; null: the daemon runs as a
                 ///< service
  std::shared_ptr<const daemon::SequenceLoader> loader;  ///< loads the sequences of clients; null: the daemon
                                                         ///< has no socket
};

class DaemonInWorld {
 public:
  /// Starts a run of the daemon.
  DaemonInWorld(const rig::RigFile& rig, Scheduler& scheduler, drivers::Board& board, Life life);
  DaemonInWorld(const DaemonInWorld&) = delete;
  DaemonInWorld& operator=(const DaemonInWorld&) = delete;
  DaemonInWorld(DaemonInWorld&&) = delete;
  DaemonInWorld& operator=(DaemonInWorld&&) = delete;
  ~DaemonInWorld() = default;

  /// Sends a request as a client does. The service thread receives the request in its next turn. `sequence`
  /// is the sequence of a start request.
  void ask(control::Request::Kind kind, std::shared_ptr<const daemon::LoadedSequence> sequence = nullptr);
  /// Requests that the daemon ends, as SIGTERM does.
  void terminate() noexcept { asked_to_end_ = true; }
  /// Ends the daemon immediately, as SIGKILL does.
  void kill();

  [[nodiscard]] ActorId actor(Part part) const { return actors_[static_cast<std::size_t>(part)]; }
  [[nodiscard]] bool owns(ActorId id) const;
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  [[nodiscard]] bool safe_state_confirmed() const { return shared.safe_state_confirmed.load(); }
  /// Returns the outcome of a daemon that ran one sequence. Call it after the end of the daemon.
  [[nodiscard]] daemon::Outcome outcome();
  /// Returns true if the daemon sends no heartbeats to the service manager any more. The manager then kills
  /// the daemon.
  [[nodiscard]] bool starved() const noexcept { return starved_; }
  [[nodiscard]] const std::map<std::uint32_t, Asked>& unanswered() const noexcept { return unanswered_; }

  rig::RigFile rig;
  WorldClock clock;
  WorldClock bus_clock;  ///< clock of the bus thread
  LoopClock loop_clock;  ///< clock of the loop, read at the beginning and the end of each tick
  Nanoseconds origin;
  control::RigController controller;
  daemon::SharedState shared;
  daemon::EventLog events;
  daemon::SequenceStore sequence_store;
  daemon::LoopStatistics loop_statistics;
  daemon::BusStatistics bus_statistics;
  daemon::Provenance provenance;
  daemon::Loop loop;
  daemon::Bus bus;
  daemon::Recorder recorder;
  daemon::Service service;
  std::optional<daemon::OneShotRun> one_shot_run;
  std::optional<SocketInWorld> socket;

  /// Called when the service has accepted a request of a client.
  std::function<void(control::Request::Kind kind, std::uint32_t id)> on_submit = [](auto, auto) {};

 private:
  struct Waiting {
    control::Request::Kind kind;
    std::shared_ptr<const daemon::LoadedSequence> sequence;
    Nanoseconds at;
  };
  void main_body();
  void service_body();
  void recorder_body();
  void look_after();
  void serve();
  [[nodiscard]] bool over() const { return asked_to_end_ || (one_shot_run && one_shot_run->finished()); }

  Scheduler& scheduler_;
  std::vector<ActorId> actors_;
  std::vector<Waiting> requests_;
  std::map<std::uint32_t, Asked> unanswered_;
  bool asked_to_end_ = false;
  bool loop_done_ = false;
  bool bus_done_ = false;
  bool stop_others_ = false;
  bool starved_ = false;
  bool ended_ = false;
};

}  // namespace softgrip::world
