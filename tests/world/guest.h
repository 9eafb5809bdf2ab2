#pragma once
// A program that uses the daemon of a world, or runs the daemon in its own process.

#include <memory>
#include <optional>

#include "tests/world/daemon_in_world.h"
#include "tests/world/surroundings.h"
#include "tests/world/tool.h"
#include "tests/world/world.h"

namespace softgrip::world {

/// The part of a world that a guest sees.
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
  /// Null: none runs.
  [[nodiscard]] virtual DaemonInWorld* daemon() = 0;
  /// How the last daemon ended; nothing: it was killed.
  [[nodiscard]] virtual const std::optional<daemon::Outcome>& outcome() const = 0;
  /// The board vented while the sequence of that daemon ran.
  [[nodiscard]] virtual bool vented_in_motion() const = 0;
  /// Starts a daemon. Only for a guest that runs it, and while none runs.
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

  /// Adds its actors.
  virtual void begin() = 0;
  /// The daemon runs in its process; else a service manager starts it, and starts it again.
  [[nodiscard]] virtual bool runs_the_daemon() const { return false; }
  /// Clients of the socket are heard.
  [[nodiscard]] virtual bool listens() const { return true; }
  /// How much rarer incidents are than with the daemon alone: of what takes minutes some comes to its end.
  [[nodiscard]] virtual double calm() const { return 1; }
  /// A daemon is to begin.
  virtual void prepare(Life& life) { static_cast<void>(life); }
  virtual void boots(DaemonInWorld& daemon) { static_cast<void>(daemon); }
  /// Another client asks the daemon for something.
  virtual void asked(control::Request::Kind kind) { static_cast<void>(kind); }
  /// Incidents of its own.
  virtual void carry_out(const Incident& incident, bool begins) {
    static_cast<void>(incident);
    static_cast<void>(begins);
  }
  /// Called once per millisecond. Judges the bounds on time.
  virtual void look(const Excuse& excuse) { static_cast<void>(excuse); }
  /// It is to come to its end; `busy` until then.
  virtual void end() {}
  [[nodiscard]] virtual bool busy() const { return false; }

  [[nodiscard]] Met& met() noexcept { return met_; }

 private:
  Met met_;
};

/// Returns null for the daemon alone.
[[nodiscard]] std::unique_ptr<Guest> make_guest(Tool tool, Host& host);
/// The rig for that tool.
[[nodiscard]] RigShape shape_for(Tool tool, const rig::RigFile& example, std::uint64_t seed,
                                 bool always_habits);

}  // namespace softgrip::world
