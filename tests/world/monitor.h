#pragma once
// The invariants, each stated once, and judged wherever it could break: at every write that reaches the board
// and after every tick.

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
  std::string invariant;  ///< its name
  std::string text;
};

/// What the daemon and its surroundings were spared of, up to now: bounds count such time only.
struct Excuse {
  bool paused = false;   ///< a thread or the whole process stands still
  bool no_line = false;  ///< something on the line or the board hinders exchanges, or none was good since
  bool line_but_for_foreign = false;  ///< the same, where another master does not count
  bool no_daemon = false;
};

class Monitor {
 public:
  /// `margin`: that of rig::watchdog_margin().
  Monitor(const control::RigSettings& rig, Nanoseconds watchdog, Nanoseconds margin);

  /// After a tick of the loop; `now` by the daemon's clock.
  void ticked(Nanoseconds now, const control::TickOutput& output);
  /// Before a write of the daemon reaches the board, whose outputs are as given. `began`: its exchange.
  void write(Nanoseconds began, Nanoseconds now, std::span<const double> outputs_kpa,
             std::span<const double> commands_kpa, bool safe_outputs);
  /// The daemon looked at its permission to move when this exchange began, now. `woke`: when its bus thread
  /// looked at its clock before, and so at the gap since the last exchange; 0: not known.
  void exchange_begins(Nanoseconds now = 0, Nanoseconds woke = 0) noexcept {
    armed_at_entry_ = armed_;
    safe_at_entry_ = safe_kpa_;
    before_ = std::exchange(exchange_, now);
    woke_ = woke;
  }
  /// For a program without a loop: it may move pressures away from rest, or may not any more.
  void may_rise(bool allowed) noexcept { armed_ = allowed; }
  /// Another master has written these. Outputs that the daemon has not read since may move again up to what
  /// it wrote itself, within the slew limits. So may those that it has read, if its safe action is to hold.
  void foreign_wrote(std::span<const double> outputs_kpa) noexcept;
  void foreign_ended() noexcept { foreign_unseen_.reset(); }
  /// The daemon has read the outputs as they were after this number of writes of another master.
  void outputs_read(std::uint64_t foreign_writes) noexcept { foreign_read_ = foreign_writes; }
  /// The board's watchdog has vented. `has_spoken`: the daemon has had a good exchange, so it can know.
  void tripped(bool has_spoken);
  void asked(control::Request::Kind kind);
  void submitted(control::Request::Kind kind, std::uint32_t id);
  /// Time has passed, with these outputs.
  void passed(Nanoseconds now, const Excuse& excuse, std::span<const double> outputs_kpa);
  /// A daemon begins to run: nothing of the last one's counts.
  void boots();
  /// It ended by itself, having written its safe outputs.
  void left(Nanoseconds now, std::span<const double> outputs_kpa);
  void answer_is_late(Nanoseconds now, Nanoseconds asked_at);
  /// The board has vented, and the user hears of something else.
  void told_nobody(Nanoseconds now, const char* otherwise) {
    violate(now, "a watchdog that has tripped is a fault", otherwise);
  }
  /// A command or an exit code breaks an invariant.
  void command_breaks(Nanoseconds now, const char* invariant, std::string text) {
    violate(now, invariant, std::move(text));
  }
  void recording_lacks(const std::string& text) { violate(0, "recordings are whole", text); }
  void leaks(const std::string& text) { violate(0, "nothing leaks", text); }

  [[nodiscard]] const std::optional<Violation>& violation() const noexcept { return violation_; }
  /// What the last tick would leave behind.
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
  bool armed_ = false;  // a start was accepted, and nothing since forbids to leave rest
  bool armed_at_entry_ = false;
  [[nodiscard]] double known_kpa(std::size_t channel, double output_kpa) const;
  bool foreign_ = false;              // another master has written since our last write
  std::uint64_t foreign_writes_ = 0;  // by another master
  std::uint64_t foreign_read_ = 0;    // of them, before the daemon's newest reading of the outputs
  std::vector<bool> foreign_left_;    // the output is still that of another master
  Nanoseconds last_began_ = 0;        // an exchange
  double elapsed_s_ = 0;              // at its first write, since the one before it
  Nanoseconds exchange_ = 0;          // when the newest one began, whether it writes or not, ...
  Nanoseconds before_ = 0;            // and the one before it
  Nanoseconds woke_ = 0;
  Nanoseconds last_woke_ = 0;  // for the exchange of last_began_
  Nanoseconds seen_ = 0;
  std::uint32_t halted_by_ = 0;  // the newest request to stop or to vent
  control::State state_ = control::State::starting;
  std::vector<double> safe_kpa_;
  std::vector<double> safe_at_entry_;
  std::vector<double> last_kpa_;  // as written
  struct Seen {                   // by the tick before
    Nanoseconds at = 0;
    Nanoseconds sampled = 0;
    model::Validity validity = model::Validity::none_yet;
  };
  std::array<Seen, control::max_channels> seen_by_{};
  std::array<control::GripResult, control::max_channels> results_{};
  std::array<std::uint16_t, control::max_channels> steps_{};
  std::array<Nanoseconds, control::max_channels> step_began_{};
  std::optional<Nanoseconds> vent_waits_;  // unexcused time since it was asked
  std::optional<Nanoseconds>
      foreign_unseen_;  // unexcused time in which another master has written something else
  std::optional<Nanoseconds> trip_untold_;  // unexcused time since the board vented
  std::optional<Nanoseconds> dead_;         // time without a daemon
};

}  // namespace softgrip::world
