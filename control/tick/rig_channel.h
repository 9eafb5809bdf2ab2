#pragma once
// The last stage of a tick: computes the command of one channel, keeps it within the output of the board, and
// reports the changes of the channel.

#include <cstddef>
#include <cstdint>

#include "control/elements/limit_watch.h"
#include "control/tick/channel_controller.h"
#include "control/tick/sequence_player.h"
#include "control/tick/settings.h"
#include "control/tick/tick.h"

namespace softgrip::control {

/// The decisions of a tick that apply to all channels. In the bit masks, bit i is channel i.
struct RigDecision {
  double time_s = 0;                     ///< time since the first tick
  State state = State::starting;         ///< state of the rig after the supervisor and the player
  std::uint32_t venting = 0;             ///< channels that go to rest while no sequence runs
  std::uint32_t venting_on_leaving = 0;  ///< channels that must vent if the loop ends now
  std::uint32_t resynchronise = 0;       ///< channels whose model is shifted to the reading
};

class RigChannel {
 public:
  RigChannel(const RigSettings& rig, std::size_t index);

  /// Starts from rest.
  void start(ChannelOutput& channel) noexcept;
  /// Executes one tick. The player gives the demand while a sequence runs, and the result of the grip. On
  /// entry, `channel` contains the output of the last tick. Returns true if the command is away from rest.
  bool tick(const TickInput& input, const RigDecision& decision, const SequencePlayer& player,
            ChannelOutput& channel, EventList& events) noexcept;

  /// See ChannelController::preview_s().
  [[nodiscard]] double preview_s() const noexcept { return controller_.preview_s(); }

 private:
  [[nodiscard]] ChannelDemand demand(const RigDecision& decision,
                                     const SequencePlayer& player) const noexcept;
  [[nodiscard]] bool free_motion(const RigDecision& decision, const SequencePlayer& player,
                                 const ChannelOutput& channel) const noexcept;
  void tell_changes(const ChannelOutput& channel, EventList& events) noexcept;
  void tell_limits(double time_s, ChannelOutput& channel, EventList& events) noexcept;
  void stay_within_outputs(const TickInput& input, double last_kpa, ChannelOutput& channel) const noexcept;

  std::size_t index_;
  double tick_s_;
  double rest_kpa_;
  ChannelController controller_;
  LimitWatch limits_;
  bool valid_before_ = true;
  bool unsteady_before_ = false;
};

}  // namespace softgrip::control
