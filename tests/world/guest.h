#pragma once
// A program in a simulated world that is a client of the daemon, or that runs the daemon in its own process.

#include <memory>
#include <optional>

#include "tests/world/daemon_in_world.h"
#include "tests/world/surroundings.h"
#include "tests/world/tool.h"
#include "tests/world/world.h"

namespace softgrip::world {

/// The functions of a world that a guest can call.
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
  /// Returns the running daemon, or null if no daemon runs.
  [[nodiscard]] virtual DaemonInWorld* daemon() = 0;
  /// Returns the outcome of the last daemon run, or nullopt if the daemon was killed.
  [[nodiscard]] virtual const std::optional<daemon::Outcome>& outcome() const = 0;
  /// Returns true if the board vented during the sequence of the last daemon run.
  [[nodiscard]] virtual bool vented_in_motion() const = 0;
  /// Starts a daemon. The caller must be a guest that runs the daemon itself, and no daemon may be running.
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

  /// Adds the threads of the guest to the scheduler.
  virtual void begin() = 0;
  /// Returns true if the daemon runs in the guest's process. Returns false if a service manager starts and
  /// restarts the daemon.
  [[nodiscard]] virtual bool runs_the_daemon() const { return false; }
  /// Returns true if the daemon has a socket for clients.
  [[nodiscard]] virtual bool listens() const { return true; }
  /// Returns the factor by which the mean time between incidents is multiplied. Commands that take minutes
  /// can finish only if incidents are rare.
  [[nodiscard]] virtual double calm() const { return 1; }
  /// Called before a daemon starts; may change the settings of its run.
  virtual void prepare(Life& life) { static_cast<void>(life); }
  virtual void boots(DaemonInWorld& daemon) { static_cast<void>(daemon); }
  /// Called when another client has sent a request to the daemon.
  virtual void asked(control::Request::Kind kind) { static_cast<void>(kind); }
  /// Begins or ends an incident that concerns only this guest.
  virtual void carry_out(const Incident& incident, bool begins) {
    static_cast<void>(incident);
    static_cast<void>(begins);
  }
  /// Checks the time limits of the guest. Called once per millisecond.
  virtual void look(const Excuse& excuse) { static_cast<void>(excuse); }
  /// Requests that the guest ends. Until then, busy() returns true.
  virtual void end() {}
  [[nodiscard]] virtual bool busy() const { return false; }

  [[nodiscard]] Met& met() noexcept { return met_; }

 private:
  Met met_;
};

/// Returns the guest for a tool, or null for Tool::none, because the daemon then runs alone.
[[nodiscard]] std::unique_ptr<Guest> make_guest(Tool tool, Host& host);
/// Returns the rig on which a tool is simulated, with a board that depends on the seed.
[[nodiscard]] RigShape shape_for(Tool tool, const rig::RigFile& example, std::uint64_t seed,
                                 bool always_habits);

}  // namespace softgrip::world
