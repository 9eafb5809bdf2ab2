#pragma once
// Computes the commands of one tick from the readings of this tick. The control loop calls this class, and
// the class calls the rest of control/. The programs softgripd and `softgrip run`, simulations in virtual
// time, tests and benchmarks use this class.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "control/elements/limit_watch.h"
#include "control/elements/rest_watch.h"
#include "control/tick/channel_controller.h"
#include "control/tick/fault_monitor.h"
#include "control/tick/sequence_player.h"
#include "control/tick/settings.h"
#include "control/tick/supervisor.h"
#include "control/tick/tick.h"

namespace softgrip::control {

/// The controller of a rig. The constructor may allocate memory. The constructor throws no other exception
/// than std::bad_alloc, because settings_problems() has checked the settings. tick() does not allocate
/// memory, does not call the operating system, and cannot fail.
class RigController {
 public:
  explicit RigController(const RigSettings& settings);
  // The control loop refers to the output inside this object, so the object must not be copied.
  RigController(const RigController&) = delete;
  RigController& operator=(const RigController&) = delete;

  /// Executes one tick. Ticks follow each other at intervals of 1/settings.rate_hz. Returns output().
  const TickOutput& tick(const TickInput& input) noexcept;

  /// Returns the output of the last tick. Before the first tick, the commands are the rest pressures.
  [[nodiscard]] const TickOutput& output() const noexcept { return output_; }

 private:
  /// The state of one channel.
  struct Channel {
    Channel(const RigSettings& rig, const ChannelSettings& settings);
    [[nodiscard]] double rest_kpa() const noexcept { return resting_kpa(controller.limits()); }
    [[nodiscard]] bool valid(const ChannelOutput& seen) const noexcept;
    [[nodiscard]] bool at_rest(const ChannelOutput& seen) const noexcept;
    [[nodiscard]] bool rests(double time_s, const ChannelOutput& seen) noexcept;

    ChannelController controller;
    RestWatch rest;
    LimitWatch limits;
    Nanoseconds longest_age;  ///< largest age of a usable reading
    bool displacement_used;   ///< true: the displacement sensor of the channel is used
    bool valid_before = true;
    bool unsteady_before = false;
    bool resynchronise = false;
    /// The reason why the last check found that the finger had not settled.
    UnsettledReason unsettled = UnsettledReason::none;
  };

  [[nodiscard]] SupervisorInputs supervisor_inputs(const TickInput& input, double time_s) noexcept;
  Rest look_for_rest(const PreparedSequence& sequence, double time_s) noexcept;
  void carry_out(const SupervisorOutputs& outputs, double time_s) noexcept;
  void report_unsettled(std::uint32_t channels) noexcept;
  void play(const TickInput& input, double time_s) noexcept;
  void release(double time_s) noexcept;
  void conclude_sequence(const SequencePlayer::Outcome& outcome, Phase phase) noexcept;
  void forget_old_readings(Nanoseconds now) noexcept;
  void stay_within_outputs(std::size_t index, double last_kpa, const TickInput& input) noexcept;
  void control(std::size_t index, const TickInput& input, double time_s) noexcept;
  [[nodiscard]] ChannelDemand demand(std::size_t index, double time_s) const noexcept;
  void tell_changes(std::size_t index) noexcept;
  void tell_limits(std::size_t index, double time_s) noexcept;
  void conclude() noexcept;
  void look_for_pressure() noexcept;

  double tick_s_;
  double rest_timeout_s_;
  double margin_mm_;
  std::vector<Channel> channels_;
  FaultMonitor monitor_;
  Supervisor supervisor_;
  SequencePlayer player_;
  TickOutput output_;
  double seeking_since_s_ = 0;
  Nanoseconds began_ = no_tick;
  Nanoseconds last_now_ = no_tick;
  bool unheard_ = false;  ///< true: after a gap between two ticks, the bus has not reported an exchange yet

  static constexpr Nanoseconds no_tick = -1;
};

}  // namespace softgrip::control
