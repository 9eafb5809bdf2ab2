#pragma once
// Executes a prepared sequence. All channels of a step start together, and the next step starts when all of
// these channels have a result. After construction, the class allocates no memory.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "control/tick/channel_player.h"
#include "control/tick/supervisor.h"
#include "control/tick/tick.h"

namespace softgrip::control {

class SequencePlayer {
 public:
  explicit SequencePlayer(std::vector<ChannelPlayer> channels = {}) : channels_(std::move(channels)) {}

  /// State of the sequence at the end of a tick.
  struct Outcome {
    bool finished = false;
    SequenceEnd end = SequenceEnd::done;
    OnFail action = OnFail::hold;  ///< action after a finished sequence: vent, hold or abort
    Phase phase = Phase::idle;     ///< phase in which the sequence finished
  };
  /// Executes one tick with the orders of the supervisor. `seen` is the output of the last tick.
  Outcome tick(const SupervisorOutputs& orders, double time_s, std::span<const ChannelOutput> seen,
               EventList& events) noexcept;
  /// Returns true if a channel has the result NO PART, PART LOST, RELEASED or ERROR.
  [[nodiscard]] bool has_answers() const noexcept;

  [[nodiscard]] ChannelDemand demand(std::size_t channel, double time_s) const noexcept;
  [[nodiscard]] const ChannelPlayer& channel(std::size_t index) const noexcept { return channels_[index]; }
  [[nodiscard]] std::uint16_t step() const noexcept { return step_; }
  /// Returns the phase of the rig, which selects the safe action.
  [[nodiscard]] Phase phase() const noexcept;
  /// Returns true if the finger moves without contact, as far as the player knows. `at_rest` is true if the
  /// command of the channel is the rest pressure.
  [[nodiscard]] bool free_motion(std::size_t channel, bool at_rest) const noexcept;

 private:
  /// Starts a sequence from rest: clears the results of its channels and begins its first step.
  void start(const PreparedSequence& sequence, double time_s, std::span<const ChannelOutput> seen,
             EventList& events) noexcept;

  /// Executes a tick of the running sequence.
  Outcome play(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;

  /// Handles a release request. The sequence continues with its next release step. Without a further release
  /// step, the sequence is finished and must be vented. A release request during a hold step lets the
  /// sequence end as `done`, and during a release step it has no effect. During any other step, it lets the
  /// sequence end as `stopped`.
  Outcome release(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;

  /// Ends the sequence because of a stop or a fault. A channel without a result gets ERROR. A channel with
  /// the result HOLDING gets ERROR if the finger may have lost the part. This is possible after a fault, and
  /// after an interrupted release of a channel that is not in `venting`.
  void interrupt(SequenceEnd end, std::uint32_t venting, EventList& events) noexcept;
  /// Executes a tick in which no sequence runs. Checks that each part that a finger held at the end of the
  /// sequence is still held.
  void idle_tick(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;
  /// Records that a vent has released these channels: their result HOLDING becomes RELEASED.
  void vented(std::uint32_t channels, EventList& events) noexcept;
  /// Sets the result ERROR for the channels of a sequence that could not start, and reports why.
  void refuse(const SupervisorOutputs& orders, std::span<const ChannelOutput> seen,
              EventList& events) noexcept;
  /// Clears the results NO PART, PART LOST, RELEASED and ERROR.
  void acknowledge(std::uint32_t request, EventList& events) noexcept;

  template <class Do>
  void for_each_of_step(Do&& act) noexcept;
  [[nodiscard]] const PreparedStep& now() const noexcept { return sequence_->steps[step_]; }
  /// Returns true if the present step is of the kind `kind`.
  [[nodiscard]] bool plays(StepKind kind) const noexcept {
    return play_ != Play::nothing && now().step.kind == kind;
  }
  void begin_step(std::uint16_t index, double time_s, std::span<const ChannelOutput> seen,
                  EventList& events) noexcept;
  Outcome next_step(std::size_t index, double time_s, std::span<const ChannelOutput> seen,
                    EventList& events) noexcept;
  Outcome go_to_step(std::size_t index, double time_s, std::span<const ChannelOutput> seen,
                     EventList& events) noexcept;
  bool take_contact(std::size_t channel, const ChannelOutput& seen, EventList& events) noexcept;
  Outcome failed(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;
  void answer_passed(std::size_t channel, double time_s, EventList& events) noexcept;
  void answer(std::size_t channel, GripResult result, GripEvidence evidence, EventList& events) noexcept;
  void tell(std::size_t channel, EventList& events) const noexcept;
  void lose(std::size_t channel, EventList& events) noexcept;
  Outcome finished(OnFail action, EventList& events) noexcept;
  void answer_the_rest(EventList& events) noexcept;
  void stop_playing() noexcept;

  enum class Play : std::uint8_t {
    nothing,      ///< no sequence runs
    step,         ///< an attempt at the present step is in progress
    backing_off,  ///< the channels return to the start of the failed attempt, before the next attempt begins
  };

  std::vector<ChannelPlayer> channels_;
  Play play_ = Play::nothing;
  const PreparedSequence* sequence_ = nullptr;  ///< the running sequence; nullptr if none runs
  std::uint16_t step_ = 0;
  std::uint32_t attempts_ = 0;           ///< number of retries of the present step
  SequenceEnd end_ = SequenceEnd::done;  ///< reason of the end: `failed` from the first failure of a step on
  std::uint32_t done_ = 0;               ///< bit mask of the channels that have a result of the present step
  std::uint32_t refused_ = 0;            ///< bit mask of the channels that have failed the present step
};

}  // namespace softgrip::control
