#pragma once
// Executes a prepared sequence. All channels of a step start together, and the next step starts when all of
// these channels have a result. The class does not allocate memory after construction.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "control/tick/channel_player.h"
#include "control/tick/tick.h"

namespace softgrip::control {

class SequencePlayer {
 public:
  explicit SequencePlayer(std::vector<ChannelPlayer> channels = {}) : channels_(std::move(channels)) {}

  /// Starts a sequence from rest: clears the results of its channels and begins its first step.
  void start(const PreparedSequence& sequence, double time_s, std::span<const ChannelOutput> seen,
             EventList& events) noexcept;

  /// State of the sequence at the end of a tick.
  struct Outcome {
    bool finished = false;
    SequenceEnd end = SequenceEnd::done;
    OnFail action = OnFail::hold;  ///< for a finished sequence, one of vent, hold and abort
  };
  /// Executes a tick of the running sequence.
  Outcome tick(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;

  /// Handles a release request. The sequence continues with its next release step. If there is no such step,
  /// the sequence is finished and must be vented. If the request comes at a time other than a hold, the
  /// sequence ends as `stopped` and not as `done`.
  Outcome release(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;

  /// Ends the sequence because of a stop or a fault. A channel without a result gets ERROR. A channel with
  /// the result HOLDING gets ERROR if it may no longer hold the part. This is the case after a fault. It is
  /// also the case if the release of the channel was interrupted and the channel is not in `venting`.
  void interrupt(SequenceEnd end, std::uint32_t venting, EventList& events) noexcept;
  /// Executes a tick in which no sequence runs: verifies that the held parts are still held.
  void idle_tick(double time_s, std::span<const ChannelOutput> seen, EventList& events) noexcept;
  /// Records that a vent has released these channels: their result HOLDING becomes RELEASED.
  void vented(std::uint32_t channels, EventList& events) noexcept;
  /// Sets the result ERROR for the channels of a sequence that could not start.
  void refuse(std::uint32_t channels, EventList& events) noexcept;
  /// Returns true if a channel has the result NO PART, PART LOST, RELEASED or ERROR.
  [[nodiscard]] bool has_answers() const noexcept;
  /// Clears the results NO PART, PART LOST, RELEASED and ERROR.
  void acknowledge(std::uint32_t request, EventList& events) noexcept;

  [[nodiscard]] ChannelDemand demand(std::size_t channel, double time_s) const noexcept;
  [[nodiscard]] const ChannelPlayer& channel(std::size_t index) const noexcept { return channels_[index]; }
  [[nodiscard]] std::uint16_t step() const noexcept { return step_; }
  /// Returns the phase of the rig, which selects the safe action.
  [[nodiscard]] Phase phase() const noexcept;
  /// Returns true if the finger moves without contact, as far as is known. `at_rest` is true if the command
  /// of the channel is the rest pressure.
  [[nodiscard]] bool free_motion(std::size_t channel, bool at_rest) const noexcept;

 private:
  template <class Do>
  void for_each_of_step(Do&& act) noexcept;
  [[nodiscard]] const PreparedStep& now() const noexcept { return sequence_->steps[step_]; }
  /// Returns true if the present step is of this kind.
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
    backing_off,  ///< the channels return to the start of the attempt, to make another attempt
  };

  std::vector<ChannelPlayer> channels_;
  Play play_ = Play::nothing;
  const PreparedSequence* sequence_ = nullptr;  ///< the running sequence; nullptr if none runs
  std::uint16_t step_ = 0;
  std::uint32_t attempts_ = 0;           ///< number of retries of the present step
  SequenceEnd end_ = SequenceEnd::done;  ///< `failed` after the first failure of a step
  std::uint32_t done_ = 0;               ///< channels that have a result of the present step
  std::uint32_t refused_ = 0;            ///< channels whose result of the present step is a failure
};

}  // namespace softgrip::control
