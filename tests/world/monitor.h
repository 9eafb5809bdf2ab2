#pragma once
// Checks the invariants of the daemon before every write that reaches the board and after every tick.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "control/tick/settings.h"
#include "control/tick/tick.h"
#include "tests/world/scheduler.h"

namespace softgrip::world {

struct Violation {
  Nanoseconds at = 0;
  std::string invariant;  ///< name of the violated invariant
  std::string text;
};

/// Disturbances of the daemon, the line and the board at this moment. Time limits do not count the time of a
/// disturbance.
struct Excuse {
  bool paused = false;   ///< true: a thread or the whole daemon process is paused
  bool no_line = false;  ///< true: the line or the board is disturbed, or no write has reached the board
                         ///< since the end of the last disturbance or since the start of the program
  bool line_but_for_foreign = false;  ///< true: no_line is true for a reason other than writes of another
                                      ///< client
  bool no_daemon = false;
};

class Monitor {
 public:
  /// Creates a monitor. `margin` is the result of rig::watchdog_margin().
  Monitor(const control::RigSettings& rig, Nanoseconds watchdog, Nanoseconds margin);

  /// Called after a tick of the loop. `now` is the time on the clock of the daemon.
  void ticked(Nanoseconds now, const control::TickOutput& output);
  /// Called before a write of the daemon reaches the board. `outputs_kpa` are the outputs of the board before
  /// the write, and `began` is the start time of the exchange.
  void write(Nanoseconds began, Nanoseconds now, std::span<const double> outputs_kpa,
             std::span<const double> commands_kpa, bool safe_outputs);
  /// Called when an exchange begins at `now`, immediately after the daemon has checked if motion is
  /// permitted. `woke` is the time at which the bus thread last read the clock; 0: unknown. The daemon uses
  /// `woke` to measure the gap since the last exchange.
  void exchange_begins(Nanoseconds now = 0, Nanoseconds woke = 0) noexcept {
    armed_at_entry_ = armed_;
    safe_at_entry_ = safe_kpa_;
    before_ = std::exchange(exchange_, now);
    woke_ = woke;
  }
  /// Specifies for a program without a control loop if it may move pressures away from rest.
  void may_rise(bool allowed) noexcept { armed_ = allowed; }
  /// Called when another client has written these outputs. Until the daemon has read the outputs, the daemon
  /// may move the outputs within the slew limits up to its own last command. After it has read the outputs,
  /// the daemon may do so only if its safe action is to hold.
  void foreign_wrote(std::span<const double> outputs_kpa) noexcept;
  void foreign_ended() noexcept { foreign_unseen_.reset(); }
  /// Called when the daemon has read the outputs. `foreign_writes` is the number of writes that another
  /// client had made before the daemon read the outputs.
  void outputs_read(std::uint64_t foreign_writes) noexcept { foreign_read_ = foreign_writes; }
  /// Called when the watchdog of the board has vented. `has_spoken` is true if the daemon has had a
  /// successful exchange before and can therefore know of the trip.
  void tripped(bool has_spoken);
  void asked(control::Request::Kind kind);
  void submitted(control::Request::Kind kind, std::uint32_t id);
  /// Called when simulated time has passed. The board had the outputs `outputs_kpa` during this time.
  void passed(Nanoseconds now, const Excuse& excuse, std::span<const double> outputs_kpa);
  /// Called when a daemon starts. Deletes the data about the previous daemon.
  void boots();
  /// Called when the daemon has written its safe outputs and has then ended without being killed.
  void left(Nanoseconds now, std::span<const double> outputs_kpa);
  void answer_is_late(Nanoseconds now, Nanoseconds asked_at);
  /// Reports a violation: the board has vented, but the message of the daemon to the user does not say so.
  /// `otherwise` describes the missing message.
  void told_nobody(Nanoseconds now, const char* otherwise) {
    violate(now, "a tripped watchdog causes a fault", otherwise);
  }
  /// Reports that the result or the exit code of a command violates an invariant.
  void command_breaks(Nanoseconds now, const char* invariant, std::string text) {
    violate(now, invariant, std::move(text));
  }
  void recording_lacks(const std::string& text) { violate(0, "recordings are complete", text); }
  void leaks(const std::string& text) { violate(0, "memory and file descriptors do not leak", text); }

  [[nodiscard]] const std::optional<Violation>& violation() const noexcept { return violation_; }
  /// Returns the safe outputs that the daemon computed in its last tick.
  [[nodiscard]] const std::vector<double>& safe_kpa() const noexcept { return safe_kpa_; }

 private:
  void violate(Nanoseconds at, const char* invariant, std::string text);
  void watch_events(Nanoseconds now, const control::TickOutput& output);
  void watch_state(Nanoseconds now, const control::TickOutput& output);
  void watch_grips(Nanoseconds now, const control::TickOutput& output);
  bool watch_gap(Nanoseconds began, Nanoseconds now, std::span<const double> commands_kpa);
  void watch_way(Nanoseconds now, std::size_t channel, double output_kpa, double command_kpa,
                 double elapsed_s, bool safe_outputs);
  void watch_foreign(Nanoseconds now, const Excuse& excuse, Nanoseconds duration);

  const control::RigSettings& rig_;
  Nanoseconds watchdog_;
  Nanoseconds margin_;
  std::optional<Violation> violation_;
  bool armed_ = false;  // true: a start was accepted, and no later event forbids a motion away from rest
  bool armed_at_entry_ = false;
  [[nodiscard]] double known_kpa(std::size_t channel, double output_kpa) const;
  bool foreign_ = false;              // true: another client has written after the last write of the daemon
  std::uint64_t foreign_writes_ = 0;  // number of writes by another client since the start of the simulation
  std::uint64_t foreign_read_ =
      0;  // number of writes by another client when the daemon last read the outputs
  std::vector<bool> foreign_left_;  // per channel; true: the output still has the value that another client
                                    // wrote
  Nanoseconds last_began_ = 0;      // start time of the last exchange with a write
  double elapsed_s_ = 0;            // time between the last two exchanges with a write [s]
  Nanoseconds exchange_ = 0;        // start time of the newest exchange, with or without a write [ns]
  Nanoseconds before_ = 0;          // start time of the exchange before the newest exchange [ns]
  Nanoseconds woke_ = 0;
  Nanoseconds last_woke_ = 0;  // time at which the bus thread last read the clock before last_began_
  Nanoseconds seen_ = 0;
  std::uint32_t halted_by_ = 0;  // id of the newest stop or vent request of a client
  control::State state_ = control::State::starting;
  std::vector<double> safe_kpa_;
  std::vector<double> safe_at_entry_;
  std::vector<double> last_kpa_;  // commands of the last write, one per channel [kPa]
  struct Seen {                   // a reading, stored until the next tick
    Nanoseconds at = 0;
    Nanoseconds sampled = 0;
    model::Validity validity = model::Validity::none_yet;
  };
  std::array<Seen, control::max_channels> seen_by_{};
  std::array<control::GripResult, control::max_channels> results_{};
  std::array<std::uint16_t, control::max_channels> steps_{};
  std::array<Nanoseconds, control::max_channels> step_began_{};
  std::optional<Nanoseconds> vent_waits_;      // time since a client requested a vent, without disturbances;
                                               // nullopt: no vent requested
  std::optional<Nanoseconds> foreign_unseen_;  // time since another client changed the outputs, without
                                               // disturbances; nullopt: not changed
  std::optional<Nanoseconds> trip_untold_;     // time since the board vented, without disturbances; nullopt:
                                               // the daemon knows of the vent
  std::optional<Nanoseconds> dead_;            // time since the last daemon ended; nullopt: a daemon runs
};

}  // namespace softgrip::world
