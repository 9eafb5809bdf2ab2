#pragma once
// A guest: a program in a simulated world that is a client of the daemon or runs the daemon in its own
// process.

#include <memory>
#include <optional>

#include "tests/world/daemon_in_world.h"
#include "tests/world/surroundings.h"
#include "tests/world/tool.h"
#include "tests/world/world.h"

namespace softgrip::world {

/// Functions of the simulated world that a guest program can call.
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
  /// Returns the running daemon. Returns null if no daemon runs.
  [[nodiscard]] virtual DaemonInWorld* daemon() = 0;
  /// Returns the outcome of the last daemon run. Returns nullopt if the daemon was killed.
  [[nodiscard]] virtual const std::optional<daemon::Outcome>& outcome() const = 0;
  /// Returns true if the board vented while the last daemon run executed its sequence.
  [[nodiscard]] virtual bool vented_in_motion() const = 0;
  /// Starts a daemon. Only a guest program that runs the daemon in its own process may call this function. No
  /// other daemon may be running.
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

  /// Adds the threads of the guest program to the scheduler.
  virtual void begin() = 0;
  /// Returns true if the daemon runs in the process of the guest program. Returns false if a service manager
  /// starts and restarts the daemon.
  [[nodiscard]] virtual bool runs_the_daemon() const { return false; }
  /// Returns true if the daemon has a socket for clients.
  [[nodiscard]] virtual bool listens() const { return true; }
  /// Returns the factor on the mean time between incidents. A command that takes minutes can finish only if
  /// incidents are rare.
  [[nodiscard]] virtual double calm() const { return 1; }
  /// Called before a daemon starts. The function may change the settings of the daemon run.
  virtual void prepare(Life& life) { static_cast<void>(life); }
  virtual void boots(DaemonInWorld& daemon) { static_cast<void>(daemon); }
  /// Called when another client has sent a request to the daemon.
  virtual void asked(control::Request::Kind kind) { static_cast<void>(kind); }
  /// Begins or ends an incident that concerns this guest program but no other part of the world.
  virtual void carry_out(const Incident& incident, bool begins) {
    static_cast<void>(incident);
    static_cast<void>(begins);
  }
  /// Checks the time limits of the guest program. Called once per millisecond.
  virtual void look(const Excuse& excuse) { static_cast<void>(excuse); }
  /// Requests the end of the guest program. busy() returns true until the program has ended.
  virtual void end() {}
  [[nodiscard]] virtual bool busy() const { return false; }

  [[nodiscard]] Met& met() noexcept { return met_; }

 private:
  Met met_;
};

/// Returns the guest program for a tool. Returns null for Tool::none, because the daemon then runs alone.
[[nodiscard]] std::unique_ptr<Guest> make_guest(Tool tool, Host& host);
/// Returns the simulated rig for a tool. The board of the rig depends on the seed.
[[nodiscard]] RigShape shape_for(Tool tool, const rig::RigFile& example, std::uint64_t seed,
                                 bool always_habits);

}  // namespace softgrip::world
