#pragma once
// One run of the daemon from start to end on the simulated clock. Loop, bus, service and recorder are those
// of a real rig; each runs the same thread body as in daemon/service/real_run.cpp.

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

/// A request of a client that has no answer yet.
struct Asked {
  control::Request::Kind kind = control::Request::Kind::none;
  Nanoseconds at = 0;
};

/// The loop's clock. As on a real machine, no two readings are equal, so the row that is written at shutdown
/// has a different time from all other rows.
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

/// The properties that can differ between two runs of the daemon.
struct Life {
  std::string folder;         ///< folder of the recordings
  std::string record_folder;  ///< if not empty: the folder of all recordings
  std::shared_ptr<const daemon::LoadedSequence>
      sequence;  ///< the sequence of a one-shot run, after which the daemon ends
  std::shared_ptr<const daemon::SequenceLoader> loader;  ///< if set, the daemon has a socket and clients
};

class DaemonInWorld {
 public:
  /// Starts the daemon.
  DaemonInWorld(const rig::RigFile& rig, Scheduler& scheduler, drivers::Board& board, Life life);
  DaemonInWorld(const DaemonInWorld&) = delete;
  DaemonInWorld& operator=(const DaemonInWorld&) = delete;
  DaemonInWorld(DaemonInWorld&&) = delete;
  DaemonInWorld& operator=(DaemonInWorld&&) = delete;
  ~DaemonInWorld() = default;

  /// Sends a request as a client does. The service thread takes the request in its next turn. `sequence`: the
  /// sequence of a start request.
  void ask(control::Request::Kind kind, std::shared_ptr<const daemon::LoadedSequence> sequence = nullptr);
  /// Requests the end of the daemon, like SIGTERM.
  void terminate() noexcept { asked_to_end_ = true; }
  /// Ends the daemon at once, like SIGKILL.
  void kill();

  [[nodiscard]] ActorId actor(Part part) const { return actors_[static_cast<std::size_t>(part)]; }
  [[nodiscard]] bool owns(ActorId id) const;
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  [[nodiscard]] bool safe_state_confirmed() const { return shared.safe_state_confirmed.load(); }
  /// Returns the outcome of the one-shot run after its end.
  [[nodiscard]] daemon::Outcome outcome();
  /// Returns true if the heartbeat to the service manager has stopped, which makes the manager kill the
  /// daemon.
  [[nodiscard]] bool starved() const noexcept { return starved_; }
  [[nodiscard]] const std::map<std::uint32_t, Asked>& unanswered() const noexcept { return unanswered_; }

  rig::RigFile rig;
  WorldClock clock;
  WorldClock bus_clock;  ///< clock of the bus thread
  LoopClock loop_clock;  ///< clock of the loop; read at the beginning and the end of a tick
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

  /// Called when the service has taken a request of a client.
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
  [[nodiscard]] bool over() const { return asked_to_end_ || (one_shot_run && one_shot_run->over()); }

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
