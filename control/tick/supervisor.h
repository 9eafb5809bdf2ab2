#pragma once
// Controls the states of the rig, latches faults, handles requests and decides the safe action.
//
//   starting -> idle -> resynchronising -> running -> idle
//                             |               |
//                             +-> stopping <--+ -> idle
//   any -> faulted -> (acknowledge) starting

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "control/tick/fault_monitor.h"
#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "control/tick/tick.h"

namespace softgrip::control {

/// Progress of the wait until the channels are at rest, before a sequence starts.
enum class Rest : std::uint8_t { pending, at_rest, timed_out };

/// Inputs of the supervisor in addition to the tick input. In the bit masks, bit i is channel i.
struct SupervisorInputs {
  Fault fault;  ///< fault that the supervisor must latch now
  Fault cause;  ///< present condition that is a fault, or becomes a fault if it lasts long enough
  bool bus_good = false;
  std::uint32_t ready = 0;    ///< channels that have a valid reading, or that need no reading
  std::uint32_t at_rest = 0;  ///< channels whose command is at the rest pressure
  Phase phase = Phase::idle;  ///< present phase of the sequence player
  bool answers = false;       ///< true: there are grip results that `acknowledge` can reset
  /// False after a gap between two ticks, until the bus reports an exchange again. During the gap, the board
  /// may have vented the fingers, and the bus reports such a vent only with the next exchange. Therefore, no
  /// step ends before this exchange.
  bool heard = true;
  Rest rest = Rest::pending;
  std::uint32_t shiftable = 0;  ///< channels at rest whose model may be shifted to the reading
  std::array<UnsettledReason, max_channels> unsettled{};  ///< reason why each channel is not at rest
};

/// Outputs of the supervisor for this tick. In the bit masks, bit i is channel i.
struct SupervisorOutputs {
  State state = State::starting;                 ///< state after the decisions of this tick
  std::uint32_t venting = 0;                     ///< see Supervisor::venting()
  std::optional<SequenceEnd> interrupt;          ///< reason for which the player must end its sequence;
                                                 ///< empty: the player continues
  std::optional<std::uint32_t> acknowledged_by;  ///< id of the request that resets the grip results; empty:
                                                 ///< no reset
  bool release = false;                          ///< true: the running sequence must continue with its
                                                 ///< release step
  bool play = false;                             ///< true: the running sequence executes a tick
  std::uint32_t vented = 0;   ///< channels that a stop or a vent has brought to their rest pressure
  std::uint32_t no_rest = 0;  ///< channels that get the result ERROR, because they did not
                              ///< come to rest
  std::array<UnsettledReason, max_channels> unsettled{};  ///< for no_rest: the reason of each channel
  bool seek_rest = false;                   ///< true: a start was accepted, so the loop must wait until
                                            ///< the channels are at rest
  const PreparedSequence* begin = nullptr;  ///< sequence that must start now, because all channels of
                                            ///< the sequence are at rest
};

class Supervisor {
 public:
  explicit Supervisor(const RigSettings& settings);

  SupervisorOutputs tick(const TickInput& input, const SupervisorInputs& inputs, EventList& events) noexcept;
  /// Ends the sequence in the supervisor. The caller calls this function when the player has reached the end
  /// of the sequence.
  void sequence_ended(SequenceEnd end, OnFail action, Phase phase, EventList& events) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] const Fault& first_fault() const noexcept { return first_fault_; }
  /// Returns a bit mask of the channels that go to their rest pressure while the state is not `running`. All
  /// other channels keep their command.
  [[nodiscard]] std::uint32_t venting() const noexcept { return venting_; }
  /// Returns a bit mask of the channels that must vent if the loop ends now while the player is in `phase`.
  [[nodiscard]] std::uint32_t venting_on_leaving(Phase phase) const noexcept;
  [[nodiscard]] const PreparedSequence* sequence() const noexcept { return sequence_; }

 private:
  void go(State state, std::uint32_t request, EventList& events) noexcept;
  void latch(const SupervisorInputs& inputs, SupervisorOutputs& outputs, EventList& events) noexcept;
  [[nodiscard]] SafeAction action_for(FaultCode code, Phase phase) const noexcept;
  void answer(const TickInput& input, const SupervisorInputs& inputs, SupervisorOutputs& outputs,
              EventList& events) noexcept;
  void answer_start(const TickInput& input, const SupervisorInputs& inputs, SupervisorOutputs& outputs,
                    EventList& events) noexcept;
  [[nodiscard]] RefusalCode refusal_of_start(const TickInput& input,
                                             const SupervisorInputs& inputs) const noexcept;
  /// Returns true if the start must be refused, and adds an event with the reason.
  [[nodiscard]] bool refuses_start(const TickInput& input, const SupervisorInputs& inputs,
                                   EventList& events) const noexcept;
  void answer_check(const TickInput& input, const SupervisorInputs& inputs, EventList& events) const noexcept;
  void answer_stop(const SupervisorInputs& inputs, const Request& request, SupervisorOutputs& outputs,
                   EventList& events) noexcept;
  void answer_stop_of(const SupervisorInputs& inputs, const Request& request, SupervisorOutputs& outputs,
                      EventList& events) noexcept;
  void answer_vent(const Request& request, SupervisorOutputs& outputs, EventList& events) noexcept;
  void answer_release(const SupervisorInputs& inputs, const Request& request, SupervisorOutputs& outputs,
                      EventList& events) noexcept;
  void answer_acknowledge(const SupervisorInputs& inputs, const Request& request, SupervisorOutputs& outputs,
                          EventList& events) noexcept;
  [[nodiscard]] bool withdrawn(std::uint32_t start) const noexcept;
  void withdraw(const Request& stop) noexcept;
  void stop(const SupervisorInputs& inputs, std::uint32_t request, SupervisorOutputs& outputs,
            EventList& events) noexcept;
  void end_sequence(SequenceEnd end, EventList& events) noexcept;
  void move_on(const SupervisorInputs& inputs, SupervisorOutputs& outputs, EventList& events) noexcept;
  [[nodiscard]] bool playing() const noexcept { return sequence_ != nullptr; }

  SafetySettings safety_;
  std::uint32_t all_;
  std::uint64_t rig_;
  State state_ = State::starting;
  Fault first_fault_;
  Phase fault_phase_ = Phase::idle;  ///< phase of the player when the first fault occurred
  std::uint32_t told_ = 0;           ///< bit mask of the faults that were reported since the first fault; bit
                                     ///< i is entry i of all_faults()
  std::uint32_t venting_ = 0;
  const PreparedSequence* sequence_ = nullptr;  ///< sequence of the accepted start; nullptr after the end of
                                                ///< the sequence
  std::uint32_t start_request_ = 0;
  std::uint32_t halted_by_ = 0;  ///< id of the newest request to vent, or to stop any sequence
  std::uint32_t taken_ = 0;      ///< id of the newest request that is neither a stop nor a vent; requests of
                                 ///< these kinds arrive in the order of their ids
  /// Ids of starts that a stop request named before these starts arrived. 64 entries are sufficient, because
  /// the queue of the loop cannot hold more starts.
  static constexpr std::size_t most_withdrawn = 64;
  std::array<std::uint32_t, most_withdrawn> withdrawn_{};
  std::size_t next_withdrawn_ = 0;  ///< index of the next entry of withdrawn_ to be written
};

}  // namespace softgrip::control
