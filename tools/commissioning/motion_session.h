#pragma once
// Moves a rig in manual mode during one command of the user. The motion runs in one thread, without the
// control loop and its controllers. `softgrip doctor` and `softgrip calibrate` use it to move fingers and
// read sensors.

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
#include "daemon/loop/statistics.h"
#include "drivers/board/board.h"

namespace softgrip::rig {
struct RigFile;
}
namespace softgrip::drivers {
class GpioLines;
}

namespace softgrip::tools {

/// Returns true if the user has requested that the command stops.
using StopRequest = std::function<bool()>;

/// Mean and standard deviation of the readings during an interval.
struct Sample {
  std::size_t count = 0;                         ///< number of valid readings during the interval
  std::size_t invalid = 0;                       ///< number of invalid readings during the interval
  model::Validity why = model::Validity::valid;  ///< reason why the last invalid reading was invalid
  double mean = 0;
  double deviation = 0;  ///< standard deviation of the readings
  double lowest = 0;
  double highest = 0;
};

/// The readings of one channel during an interval.
struct ChannelSample {
  Sample displacement_mm;
  Sample pressure_kpa;  ///< sample of the pressure monitor; `count` is 0 if the channel has no pressure
                        ///< monitor
  Sample readback_kpa;  ///< sample of the output's read-back; `count` is 0 if the board cannot read its
                        ///< outputs back
};

/// The reason why a motion of a session has ended.
struct MotionFailure {
  enum class Kind : std::uint8_t {
    stopped,   ///< the user stopped the motion
    bus,       ///< the board did not respond, or its outputs differ from the values that the session wrote
    beyond,    ///< the finger left the displacement limits of its channel
    pressure,  ///< the measured pressure left the pressure limits of its channel
    blind,     ///< a sensor that the motion requires gives no valid readings
    emergency_stop,  ///< the emergency stop is pressed or cannot be read, or the enable output cannot be
                     ///< switched on
  };
  Kind kind = Kind::bus;
  std::string text;
  drivers::BusStatus status = drivers::BusStatus::ok;  ///< for `bus`: the status of the failed exchange
};

/// The sensors of a channel that must give valid readings while the channel moves.
struct Sight {
  std::size_t channel = 0;
  bool displacement = false;
  bool pressure = false;  ///< true: the pressure monitor must give valid readings
};

/// Drives a board with the daemon's own bus (daemon/loop/bus.h) in place of the control loop. As in the
/// daemon, a gap in communication that is as long as the board's watchdog time means that the board has
/// vented. The bus then writes the rest pressures.
///
/// - Outputs move away from rest only in ramp(). A ramp starts from the last confirmed values and stays
/// within the slew limits. A gap does not make the next step larger.
/// - The session ends if a gap reaches the watchdog time.
/// - The session ends if the board reports a trip, rejects a write or was written by another client.
/// - The session ends if the board does not respond for `bus_down_cycles`.
/// - The session ends if a measured pressure is outside the pressure limits of its channel for several
/// cycles.
/// - If the rig has an emergency stop, the session moves no finger while the emergency stop is pressed. If
/// the emergency stop is pressed during a motion, the session ends, and leave() writes the rest pressures at
/// once.
/// - The enable output is on from the first ramp until the end of leave().
/// - After its end, the session moves nothing, and every later call returns the same failure. Only leave()
/// still writes. Its values are not further from rest than the present outputs.
/// - The session writes the rest pressures from the first exchange on. After its destruction, all channels
/// are at rest, or leave() has returned false.
class MotionSession {
 public:
  template <class T>
  using Expected = tl::expected<T, MotionFailure>;
  /// Called after every successful exchange, with the commands and the readings of this exchange.
  using Watch = std::function<void(const std::vector<double>& commands_kpa,
                                   const std::vector<model::Reading>& readings)>;
  /// Called with the reason when the board stops responding.
  using Warn = std::function<void(const std::string& why)>;

  /// Creates a session for `board`, which must not be connected yet. The session uses `clock` for all waits
  /// and to measure gaps in communication. `lines` are the digital lines of the rig. Without `lines`, a rig
  /// with an emergency stop or an enable output is not moved. All references must outlive the session.
  MotionSession(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                drivers::GpioLines* lines = nullptr);
  MotionSession(const MotionSession&) = delete;
  MotionSession& operator=(const MotionSession&) = delete;
  MotionSession(MotionSession&&) = delete;
  MotionSession& operator=(MotionSession&&) = delete;
  ~MotionSession();

  [[nodiscard]] Expected<void> connect();
  /// Prevents motion away from rest until the sensors in `sight` have given a valid reading. The session ends
  /// after `invalid_reading_cycles` consecutive cycles in which one of these sensors has no valid reading.
  void require(Sight sight);
  /// Holds the commands for `duration_s` and returns the statistics of the readings of every channel.
  [[nodiscard]] Expected<std::vector<ChannelSample>> sample(double duration_s, const Watch& watch = {});
  /// Ramps the command of one channel to `to_kpa` at `speed_kpa_per_s`, within the slew limits. The session
  /// ends if a finger leaves its displacement limits or its pressure limits.
  [[nodiscard]] Expected<void> ramp(std::size_t channel, double to_kpa, double speed_kpa_per_s,
                                    const Watch& watch = {});
  /// Holds all commands and exchanges data with the board until `done` returns true. A caller uses it, for
  /// example, while a person answers a question.
  [[nodiscard]] Expected<void> wait(const std::function<bool()>& done);
  /// Ramps all channels to their rest pressures within the slew limits and ends the session. Returns true if
  /// the board confirmed the rest pressures. The rest pressures are written at once if the emergency stop is
  /// pressed, or if the board has not responded for its watchdog time. While the board does not respond, the
  /// ramp continues in time. Calls `silent` at most once, when the board does not respond.
  bool leave(const Warn& silent = {}) noexcept;

  [[nodiscard]] double command_kpa(std::size_t channel) const { return commands_[channel]; }
  [[nodiscard]] Nanoseconds period() const noexcept { return schedule_.period(); }
  /// Returns the durations of all successful exchanges since the session began.
  [[nodiscard]] const daemon::Histogram& exchange_times() const noexcept;

 private:
  struct Line;  // the bus, and the data that the session shares with the bus in place of the control loop

  [[nodiscard]] Expected<void> step(bool may_rise, const Watch& watch);
  void exchange(bool may_rise, bool last) noexcept;
  void take_report(std::uint64_t skipped_cycles) noexcept;
  [[nodiscard]] std::optional<MotionFailure> bus_failure() const;
  [[nodiscard]] std::string complaint() const;
  [[nodiscard]] tl::unexpected<MotionFailure> end(MotionFailure failure);
  void follow_targets(double speed_kpa_per_s, double elapsed_s) noexcept;
  [[nodiscard]] bool rest(const Warn& silent) noexcept;
  [[nodiscard]] std::optional<MotionFailure> beyond() const;
  [[nodiscard]] std::optional<MotionFailure> overpressure();
  [[nodiscard]] std::optional<MotionFailure> emergency_stop() const;
  [[nodiscard]] bool set_enable(bool on) noexcept;
  [[nodiscard]] bool seen() const;
  [[nodiscard]] MotionFailure blind() const;

  const rig::RigFile& rig_;
  drivers::Board& board_;
  const Clock& clock_;
  StopRequest stop_;
  drivers::GpioLines* lines_;
  std::unique_ptr<Line> line_;
  PeriodicSchedule schedule_;
  bool moved_ = false;
  std::optional<MotionFailure> ended_;
  std::vector<double> commands_;  // the present outputs [kPa]; during an exchange, the values that the
                                  // exchange writes
  std::vector<double> targets_;
  std::vector<double> rest_;
  std::vector<model::Reading> readings_;
  std::uint64_t silent_cycles_ = 0;             // number of cycles since the last successful exchange
  Nanoseconds last_good_ = 0;                   // end of the last successful exchange
  std::vector<std::uint64_t> pressure_cycles_;  // by channel: number of cycles since the measured pressure
                                                // was last inside its limits
  std::optional<Sight> required_;
  std::uint32_t blind_cycles_ = 0;  // number of cycles since all required sensors last had valid readings
  bool may_rise_ = true;  // true: all required sensors have had valid readings since the call of require()
};

}  // namespace softgrip::tools
