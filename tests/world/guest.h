#pragma once
// A program in a simulated world that uses the daemon or runs the daemon in its own process.

#include <memory>
#include <optional>

#include "tests/world/daemon_in_world.h"
#include "tests/world/surroundings.h"
#include "tests/world/tool.h"
#include "tests/world/world.h"

namespace softgrip::world {

/// The interface of a world for a guest.
class Host {
 public:
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  Host(Host&&) = delete;
  Host& operator=(Host&&) = delete;
  virtual ~Host() = default;

  [[nodiscard]] virtual const Library& library() const = 0;
  [[nodiscard]] virtual Surroundings& around() = 0;
  /// Returns the running daemon, or null.
  [[nodiscard]] virtual DaemonInWorld* daemon() = 0;
  /// Returns the outcome of the last daemon, or nullopt if the daemon was killed.
  [[nodiscard]] virtual const std::optional<daemon::Outcome>& outcome() const = 0;
  /// Returns true if the board vented while the sequence of the last daemon was running.
  [[nodiscard]] virtual bool vented_in_motion() const = 0;
  /// Starts a daemon. Only a guest that runs the daemon may call it, and only while no daemon runs.
  virtual void boot(Life life) = 0;
};

class Guest {
 public:
  Guest() = default;
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;
  Guest(Guest&&) = delete;
  Guest& operator=(Guest&&) = delete;
  virtual ~Guest() = default;

  /// Adds the guest's actors to the scheduler.
  virtual void begin() = 0;
  /// True: the daemon runs in the guest's process. False: a service manager starts and restarts it.
  [[nodiscard]] virtual bool runs_the_daemon() const { return false; }
  /// True: the daemon serves clients of the socket.
  [[nodiscard]] virtual bool listens() const { return true; }
  /// Factor of the mean time between incidents. Commands that take minutes finish only if incidents are
  /// rarer.
  [[nodiscard]] virtual double calm() const { return 1; }
  /// Called before a daemon starts.
  virtual void prepare(Life& life) { static_cast<void>(life); }
  virtual void boots(DaemonInWorld& daemon) { static_cast<void>(daemon); }
  /// Called when another client sends a request to the daemon.
  virtual void asked(control::Request::Kind kind) { static_cast<void>(kind); }
  /// Begins or ends an incident that concerns only this guest.
  virtual void carry_out(const Incident& incident, bool begins) {
    static_cast<void>(incident);
    static_cast<void>(begins);
  }
  /// Called once per millisecond; checks the time limits.
  virtual void look(const Excuse& excuse) { static_cast<void>(excuse); }
  /// Requests the end of the guest, which is `busy` until then.
  virtual void end() {}
  [[nodiscard]] virtual bool busy() const { return false; }

  [[nodiscard]] Met& met() noexcept { return met_; }

 private:
  Met met_;
};

/// Returns null for Tool::none, the daemon alone.
[[nodiscard]] std::unique_ptr<Guest> make_guest(Tool tool, Host& host);
/// Returns the rig for a tool.
[[nodiscard]] RigShape shape_for(Tool tool, const rig::RigFile& example, std::uint64_t seed,
                                 bool always_habits);

}  // namespace softgrip::world
