#pragma once
// Computes the command of one finger in one tick from the reading and the reference of the finger. The limits
// apply to the sum of feedforward and PID feedback. The model runs in parallel, with the commands that were
// sent to the board.

#include <cstdint>
#include <optional>

#include "control/elements/jump_watch.h"
#include "control/elements/model_health.h"
#include "control/elements/pid.h"
#include "control/elements/plausibility.h"
#include "control/feedforward/feedforward_kinds.h"
#include "control/feedforward/free_curve.h"
#include "control/feedforward/running_model.h"
#include "control/tick/channel_demand.h"
#include "control/tick/settings.h"
#include "control/tick/tick.h"
#include "model/reading.h"

namespace softgrip::control {

struct ChannelInput {
  Nanoseconds now = 0;     ///< time at which the tick started
  model::Reading reading;  ///< newest reading that the driver returned
  ChannelDemand demand;    ///< demand of the sequence player or of the supervisor
  /// True: sets the offset of the model to the difference between reading and model. The caller requests this
  /// only at rest, before a motion starts; see ChannelOutput::synchronised.
  bool resynchronise = false;
  /// True if the finger moves without contact, as far as the controller knows. Only then, the residual shows
  /// the error of the model.
  bool free_motion = true;
};

/// Computes the commands of one channel. The settings must be in the ranges that their headers state. If
/// check_feedforward() (control/feedforward/invertibility.h) refuses the model for the configured
/// feedforward, the channel has no feedforward. A caller must not operate a channel whose model has a settled
/// displacement that does not rise with the command, because the feedback would be unstable.
class ChannelController {
 public:
  ChannelController(const ChannelSettings& settings, double tick_s);

  /// Starts from rest. `command_kpa` is the present output of the board.
  void start(double command_kpa, ChannelOutput& channel) noexcept;

  /// Runs one period. On entry, `channel` contains the result of start() or of the last tick. On return, it
  /// contains the result of this tick, except the members result, evidence, step, limit and safe_kpa. If two
  /// calls are more than one period apart (missed cycles), the model computes the missed ticks.
  void tick(const ChannelInput& input, ChannelOutput& channel) noexcept;

  /// Returns how far ahead of now the feedforward reads the reference [s]. To avoid a step of the command,
  /// cut the reference at now + preview_s() and not earlier.
  [[nodiscard]] double preview_s() const noexcept { return feedforward_.preview_s(); }
  [[nodiscard]] const LimitSettings& limits() const noexcept { return limits_; }

 private:
  /// The source of the command in a tick.
  enum class Loop : std::uint8_t {
    stopped,  ///< there has been no tick since the call of start()
    open,     ///< the demand gives the command without feedback: hold, vent, pressure
    closed,   ///< the command is the sum of feedforward and feedback
    held,     ///< the command is the sum of feedforward and a feedback that is held constant
  };
  [[nodiscard]] bool tracking() const noexcept { return loop_ == Loop::closed || loop_ == Loop::held; }

  [[nodiscard]] std::int64_t advance(Nanoseconds now, double command_kpa) noexcept;
  double take_reading(const ChannelInput& input, ChannelOutput& channel) noexcept;
  void watch_jumps(const model::Reading& reading, double predicted_mm, ChannelOutput& channel) noexcept;
  void follow_finger(bool wanted, double predicted_mm, ChannelOutput& channel) noexcept;
  void watch_model(const ChannelInput& input, double predicted_mm, bool is_new,
                   ChannelOutput& channel) noexcept;
  void weigh(double predicted_mm, ChannelOutput& channel) noexcept;
  void send(const ChannelDemand& demand, double wanted_kpa, ChannelOutput& channel) noexcept;
  double request(const ChannelDemand& demand, std::int64_t ticks, ChannelOutput& channel) noexcept;
  double track(const ChannelDemand& demand, std::int64_t ticks, ChannelOutput& channel) noexcept;

  double tick_s_;
  LimitSettings limits_;
  double noise_mm_;
  double need_share_;  ///< filter coefficient of ChannelOutput::free_kpa: share of the distance to the
                       ///< unfiltered value that one tick covers
  bool displacement_used_;
  RunningModel running_;
  FreeCurve curve_;
  Feedforward feedforward_;
  Pid pid_;
  Plausibility plausibility_;
  JumpWatch jumps_;
  ModelHealth health_;

  Loop loop_ = Loop::stopped;
  Nanoseconds last_now_ = 0;
  std::uint32_t sequence_ = 0;  ///< sequence number of the last reading
  double offset_mm_ = 0;
  /// during resynchronisation: number of ticks for which the residual has been within the noise
  std::optional<std::int64_t> settled_ticks_;
};

}  // namespace softgrip::control
