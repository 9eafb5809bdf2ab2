#pragma once
// Manual motion of a rig by one command: no loop, no controller, one thread. `softgrip doctor` and `softgrip
// calibrate` move and read with it.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/clock.h"
#include "base/periodic_schedule.h"
#include "daemon/loop/histogram.h"
#include "drivers/board/board.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools {

/// True once the user has asked the command to end.
using StopRequest = std::function<bool()>;

/// Mean and spread of what was read in a while.
struct Sample {
  std::size_t count = 0;                         ///< of valid readings
  std::size_t invalid = 0;                       ///< of the others ...
  model::Validity why = model::Validity::valid;  ///< ... and what the last of them said
  double mean = 0;
  double deviation = 0;  ///< standard deviation of one reading
  double lowest = 0;
  double highest = 0;
};

/// What a channel said in a while.
struct ChannelSample {
  Sample displacement_mm;
  Sample pressure_kpa;  ///< count 0 without a pressure monitor
  Sample readback_kpa;  ///< count 0 if the board does not read its outputs back
};

/// Why a motion has ended.
struct MotionFailure {
  enum class Kind : std::uint8_t {
    stopped,  ///< by the user
    bus,      ///< the board did not answer, or its outputs are not those of the session
    beyond,   ///< the finger left its displacement limits
    blind,    ///< a sensor that the motion needs gives no valid readings
  };
  Kind kind = Kind::bus;
  std::string text;
  drivers::BusStatus status = drivers::BusStatus::ok;  ///< `bus`: of what it failed
};

/// The sensors of a channel that must give valid readings while it moves.
struct Sight {
  std::size_t channel = 0;
  bool displacement = false;
  bool pressure = false;  ///< by the pressure monitor
};

/// Drives a board by the daemon's own bus (daemon/loop/bus.h), in the place of the loop, with the same rule
/// for gaps. After a gap as long as the board's watchdog time the board has vented. Then the bus writes the
/// rest pressures.
///
/// - Outputs move away from rest only in ramp(), from what the board has confirmed, within the slew limits.
///   A gap does not make the next step larger.
/// - The session ends if a gap reaches the watchdog time.
/// - It ends if the board reports a trip, refuses a write or is written by another client.
/// - It ends if the board does not answer for `bus_down_cycles`.
/// - A session that has ended moves nothing. Every later call returns the same failure. Only leave() writes,
///   and nothing further from rest than the present outputs.
/// - It writes the rest pressures from the first exchange on. On destruction everything is at rest again, or
///   leave() returned false.
class MotionSession {
 public:
  template <class T>
  using Expected = tl::expected<T, MotionFailure>;
  /// Called after every good exchange with the commands that were written and what was read.
  using Watch = std::function<void(const std::vector<double>& commands_kpa,
                                   const std::vector<model::Reading>& readings)>;

  /// `board` is not connected yet. It sleeps and measures gaps by `clock` alone. All references outlive the
  /// session.
  MotionSession(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop);
  MotionSession(const MotionSession&) = delete;
  MotionSession& operator=(const MotionSession&) = delete;
  MotionSession(MotionSession&&) = delete;
  MotionSession& operator=(MotionSession&&) = delete;
  ~MotionSession();

  [[nodiscard]] Expected<void> connect();
  /// From now on nothing moves away from rest before these sensors have given a valid reading. After
  /// `invalid_reading_cycles` readings in a row that are not valid the session ends.
  void require(Sight sight);
  /// Keeps the commands for so long; what was read of every channel meanwhile.
  [[nodiscard]] Expected<std::vector<ChannelSample>> sample(double duration_s, const Watch& watch = {});
  /// Moves one channel to a command, no faster than `speed_kpa_per_s` and the limits. A finger beyond its
  /// limits ends the session, too.
  [[nodiscard]] Expected<void> ramp(std::size_t channel, double to_kpa, double speed_kpa_per_s,
                                    const Watch& watch = {});
  /// Keeps everything as it is and talks to the board until `done` says so: while a person is asked
  /// something.
  [[nodiscard]] Expected<void> wait(const std::function<bool()>& done);
  /// Everything to its rest pressure, at the limits' slew, and the end of the session. True if the
  /// board confirmed it.
  bool leave() noexcept;

  [[nodiscard]] double command_kpa(std::size_t channel) const { return commands_[channel]; }
  [[nodiscard]] Nanoseconds period() const noexcept { return schedule_.period(); }
  /// Durations of the good exchanges so far.
  [[nodiscard]] const daemon::Histogram& exchange_times() const noexcept;

 private:
  struct Line;  // the bus, and the shared on which the session speaks to it as the loop does

  [[nodiscard]] Expected<void> step(bool may_rise, const Watch& watch);
  void exchange(bool may_rise, bool last) noexcept;
  void take_report(std::uint64_t skipped_cycles) noexcept;
  [[nodiscard]] std::optional<MotionFailure> bus_failure() const;
  [[nodiscard]] std::string complaint() const;
  [[nodiscard]] tl::unexpected<MotionFailure> end(MotionFailure failure);
  void follow_targets(double speed_kpa_per_s) noexcept;
  [[nodiscard]] std::optional<MotionFailure> beyond() const;
  [[nodiscard]] bool seen() const;
  [[nodiscard]] MotionFailure blind() const;

  const rig::RigFile& rig_;
  drivers::Board& board_;
  const Clock& clock_;
  StopRequest stop_;
  std::unique_ptr<Line> line_;
  PeriodicSchedule schedule_;
  bool moved_ = false;
  std::optional<MotionFailure> ended_;
  std::vector<double> commands_;  // the present outputs, then the next write
  std::vector<double> targets_;
  std::vector<double> rest_;
  std::vector<model::Reading> readings_;
  std::uint64_t silent_cycles_ = 0;  // since the last good exchange
  std::optional<Sight> required_;
  std::uint32_t blind_cycles_ = 0;  // since the required sensors were all seen
  bool may_rise_ = true;            // they were seen since they are required
};

}  // namespace softgrip::tools
