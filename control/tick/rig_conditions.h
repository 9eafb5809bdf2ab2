#pragma once
// The first stage of a tick: finds the conditions on which the supervisor decides.

#include <span>
#include <vector>

#include "control/elements/rest_watch.h"
#include "control/tick/fault_monitor.h"
#include "control/tick/sequence_player.h"
#include "control/tick/settings.h"
#include "control/tick/supervisor.h"
#include "control/tick/tick.h"

namespace softgrip::control {

class RigConditions {
 public:
  explicit RigConditions(const RigSettings& settings);

  /// Returns the conditions of one tick. `seen` is the output of the last tick. After a gap between two
  /// ticks, its readings are invalidated, because they no longer show if a part is held or if a finger is at
  /// rest.
  SupervisorInputs observe(const TickInput& input, double time_s, const Supervisor& supervisor,
                           const SequencePlayer& player, std::span<ChannelOutput> seen) noexcept;
  /// Starts the wait until the channels are at rest. While the supervisor is in the state `resynchronising`,
  /// each tick checks if they are at rest.
  void seek_rest(double time_s) noexcept;
  /// Returns the most severe fault condition of the tick; see FaultMonitor::cause().
  [[nodiscard]] const Fault& cause() const noexcept { return monitor_.cause(); }

 private:
  /// Constants of a channel, and the watch that detects that its finger is at rest.
  struct Channel {
    Channel(const RigSettings& rig, const ChannelSettings& settings);
    [[nodiscard]] bool valid(const ChannelOutput& seen) const noexcept;
    [[nodiscard]] bool at_rest(const ChannelOutput& seen) const noexcept;
    [[nodiscard]] bool rests(double time_s, const ChannelOutput& seen) noexcept;

    RestWatch rest;
    double rest_kpa;
    Nanoseconds longest_age;  ///< largest age of a usable reading
    bool displacement_used;   ///< true: the displacement sensor of the channel is used
  };

  void forget_old_readings(Nanoseconds now, std::span<ChannelOutput> seen) noexcept;
  [[nodiscard]] bool heard(const TickInput& input) noexcept;
  void look_for_rest(const PreparedSequence& sequence, double time_s, std::span<const ChannelOutput> seen,
                     SupervisorInputs& inputs) noexcept;

  FaultMonitor monitor_;
  std::vector<Channel> channels_;
  double rest_timeout_s_;
  double margin_mm_;
  double seeking_since_s_ = 0;
  Nanoseconds last_now_ = no_tick;
  bool unheard_ = false;  ///< true: after a gap between two ticks, the bus has not reported an exchange yet

  static constexpr Nanoseconds no_tick = -1;
};

}  // namespace softgrip::control
