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

#include "control/elements/limits.h"
#include "drivers/board/board.h"
#include "drivers/board/channel_wiring.h"
#include "rig/loop_settings.h"

namespace softgrip::rig {
struct RigFile;
}

namespace softgrip::tools {

/// Where the time comes from, and whether somebody wants an end.
class Pace {
 public:
  Pace() = default;
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;
  Pace(Pace&&) = delete;
  Pace& operator=(Pace&&) = delete;
  virtual ~Pace() = default;
  [[nodiscard]] virtual Nanoseconds now() noexcept = 0;
  virtual void sleep_until(Nanoseconds due) noexcept = 0;
  /// True once Ctrl-C came, or whatever else ends a command.
  [[nodiscard]] virtual bool stopped() noexcept = 0;
};

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

/// Why something was not done.
struct MotionFailure {
  enum class Kind : std::uint8_t {
    stopped,  ///< by the user
    bus,      ///< the board did not answer
    beyond,   ///< the finger left its displacement limits
  };
  Kind kind = Kind::bus;
  std::string text;
};

/// Writes the lowest pressures from the first exchange on; every command passes the rig's limits. On
/// destruction everything is at its lowest again, whatever happened, or safe() says that nobody confirmed it.
class MotionSession {
 public:
  template <class T>
  using Expected = tl::expected<T, MotionFailure>;
  /// Called after every exchange with the commands that were written and what was read.
  using Watch = std::function<void(const std::vector<double>& commands_kpa,
                                   const std::vector<model::Reading>& readings)>;

  /// `board` may be connected already; rig, board and pace outlive it.
  MotionSession(const rig::RigFile& rig, drivers::Board& board, Pace& pace);
  MotionSession(const MotionSession&) = delete;
  MotionSession& operator=(const MotionSession&) = delete;
  MotionSession(MotionSession&&) = delete;
  MotionSession& operator=(MotionSession&&) = delete;
  ~MotionSession();

  [[nodiscard]] Expected<void> connect();
  /// Keeps the commands for so long; what was read of every channel meanwhile.
  [[nodiscard]] Expected<std::vector<ChannelSample>> sample(double duration_s, const Watch& watch = {});
  /// Moves one channel to a command, no faster than `speed_kpa_per_s` and the limits. A finger beyond its
  /// limits, and Ctrl-C, end it; then leave() is due.
  [[nodiscard]] Expected<void> ramp(std::size_t channel, double to_kpa, double speed_kpa_per_s,
                                    const Watch& watch = {});
  /// Keeps everything as it is and talks to the board until `done` says so: while a person is asked
  /// something.
  [[nodiscard]] Expected<void> wait(const std::function<bool()>& done);
  /// Everything down to its lowest pressure, at the limits' slew. True if the board confirmed it.
  bool leave() noexcept;

  [[nodiscard]] double command_kpa(std::size_t channel) const { return commands_[channel]; }
  [[nodiscard]] Nanoseconds period() const noexcept { return period_; }
  /// Durations of the exchanges so far [s].
  [[nodiscard]] const std::vector<double>& exchange_times_s() const noexcept { return exchange_times_s_; }

 private:
  [[nodiscard]] Expected<void> step(const Watch& watch);
  [[nodiscard]] drivers::BusStatus exchange() noexcept;
  void follow_targets(double speed_kpa_per_s) noexcept;
  [[nodiscard]] std::optional<MotionFailure> beyond() const;

  const rig::RigFile& rig_;
  drivers::Board& board_;
  Pace& pace_;
  Nanoseconds period_;
  Nanoseconds due_ = 0;
  bool connected_ = false;
  bool moved_ = false;
  std::vector<double> commands_;
  std::vector<double> targets_;
  std::vector<model::Reading> readings_;
  std::vector<double> exchange_times_s_;
  std::uint32_t failures_ = 0;
};

/// CLOCK_BOOTTIME, and SIGINT, SIGTERM and SIGHUP as the wish to end.
class RealPace final : public Pace {
 public:
  RealPace();
  ~RealPace() override;
  [[nodiscard]] Nanoseconds now() noexcept override;
  void sleep_until(Nanoseconds due) noexcept override;
  [[nodiscard]] bool stopped() noexcept override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::tools
