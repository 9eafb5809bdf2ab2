#pragma once
// Checks the invariants of the daemon at every write that reaches the board and after every tick.

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
  std::string invariant;  ///< name of the invariant
  std::string text;
};

/// Present disturbances of the daemon and its surroundings. Time during a disturbance does not count for time
/// limits.
struct Excuse {
  bool paused = false;   ///< a thread or the whole process is paused
  bool no_line = false;  ///< the line or the board hinders exchanges, or no exchange has succeeded since
  bool line_but_for_foreign = false;  ///< like no_line, but writes of another client do not count
  bool no_daemon = false;
};

class Monitor {
 public:
  /// `margin`: the result of rig::watchdog_margin().
  Monitor(const control::RigSettings& rig, Nanoseconds watchdog, Nanoseconds margin);

  /// Called after a tick of the loop; `now` is the time on the daemon's clock.
  void ticked(Nanoseconds now, const control::TickOutput& output);
  /// Called before a write of the daemon reaches the board with the given outputs. `began`: start of the
  /// exchange.
  void write(Nanoseconds began, Nanoseconds now, std::span<const double> outputs_kpa,
             std::span<const double> commands_kpa, bool safe_outputs);
  /// Called when an exchange begins at `now`; the daemon has just read its permission to move. `woke`: time
  /// at which its bus thread last read the clock, with which it measures the gap since the last exchange; 0:
  /// unknown.
  void exchange_begins(Nanoseconds now = 0, Nanoseconds woke = 0) noexcept {
    armed_at_entry_ = armed_;
    safe_at_entry_ = safe_kpa_;
    before_ = std::exchange(exchange_, now);
    woke_ = woke;
  }
  /// States for a program without a loop whether it may move pressures away from rest.
  void may_rise(bool allowed) noexcept { armed_ = allowed; }
  /// Called when another client has written these outputs. Outputs that the daemon has not read since may
  /// move again, within the slew limits, up to the daemon's own last command. Outputs that it has read may do
  /// so if its safe action is to hold.
  void foreign_wrote(std::span<const double> outputs_kpa) noexcept;
  void foreign_ended() noexcept { foreign_unseen_.reset(); }
  /// Called when the daemon has read the outputs, after this number of writes of another client.
  void outputs_read(std::uint64_t foreign_writes) noexcept { foreign_read_ = foreign_writes; }
  /// Called when the board's watchdog has vented. `has_spoken`: the daemon has had a successful exchange, so
  /// it can know of the trip.
  void tripped(bool has_spoken);
  void asked(control::Request::Kind kind);
  void submitted(control::Request::Kind kind, std::uint32_t id);
  /// Called when time has passed with these outputs.
  void passed(Nanoseconds now, const Excuse& excuse, std::span<const double> outputs_kpa);
  /// Called when a daemon starts: forgets the state of the previous daemon.
  void boots();
  /// Called when the daemon has ended by itself after writing its safe outputs.
  void left(Nanoseconds now, std::span<const double> outputs_kpa);
  void answer_is_late(Nanoseconds now, Nanoseconds asked_at);
  /// Reports a violation: the board has vented, but the user receives the message `otherwise`, which does not
  /// say so.
  void told_nobody(Nanoseconds now, const char* otherwise) {
    violate(now, "a watchdog that has tripped is a fault", otherwise);
  }
  /// Reports that a command or an exit code violates an invariant.
  void command_breaks(Nanoseconds now, const char* invariant, std::string text) {
    violate(now, invariant, std::move(text));
  }
  void recording_lacks(const std::string& text) { violate(0, "recordings are whole", text); }
  void leaks(const std::string& text) { violate(0, "nothing leaks", text); }

  [[nodiscard]] const std::optional<Violation>& violation() const noexcept { return violation_; }
  /// Returns the safe outputs of the last tick.
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
  bool armed_ = false;  // a start was accepted, and no later event forbids leaving rest
  bool armed_at_entry_ = false;
  [[nodiscard]] double known_kpa(std::size_t channel, double output_kpa) const;
  bool foreign_ = false;              // another client has written since the daemon's last write
  std::uint64_t foreign_writes_ = 0;  // number of writes by another client
  std::uint64_t foreign_read_ =
      0;  // number of these writes before the daemon's newest reading of the outputs
  std::vector<bool> foreign_left_;  // per channel: the output is still the one that another client wrote
  Nanoseconds last_began_ = 0;      // start of the last exchange that wrote
  double elapsed_s_ = 0;            // time from the previous writing exchange to this one
  Nanoseconds exchange_ = 0;        // start of the newest exchange, with or without a write
  Nanoseconds before_ = 0;          // start of the exchange before exchange_
  Nanoseconds woke_ = 0;
  Nanoseconds last_woke_ = 0;  // value of woke_ for the exchange that began at last_began_
  Nanoseconds seen_ = 0;
  std::uint32_t halted_by_ = 0;  // id of the newest stop or vent request
  control::State state_ = control::State::starting;
  std::vector<double> safe_kpa_;
  std::vector<double> safe_at_entry_;
  std::vector<double> last_kpa_;  // the last written commands
  struct Seen {                   // reading of the previous tick
    Nanoseconds at = 0;
    Nanoseconds sampled = 0;
    model::Validity validity = model::Validity::none_yet;
  };
  std::array<Seen, control::max_channels> seen_by_{};
  std::array<control::GripResult, control::max_channels> results_{};
  std::array<std::uint16_t, control::max_channels> steps_{};
  std::array<Nanoseconds, control::max_channels> step_began_{};
  std::optional<Nanoseconds> vent_waits_;  // time since the vent was requested, except during disturbances
  std::optional<Nanoseconds>
      foreign_unseen_;  // time since another client has changed the outputs, except during disturbances
  std::optional<Nanoseconds> trip_untold_;  // time since the board vented, except during disturbances
  std::optional<Nanoseconds> dead_;         // time without a daemon
};

}  // namespace softgrip::world
