#pragma once
// The values of one tick: what goes into RigController (control/tick/rig_controller.h) and what comes out of
// it. Plain values without memory of their own; they cross between threads as they are.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "control/elements/fault.h"
#include "control/elements/grip_result.h"
#include "control/elements/limit_watch.h"
#include "control/elements/model_health.h"
#include "control/tick/settings.h"
#include "model/reading.h"

namespace softgrip::control {

struct PreparedSequence;  // control/tick/sequence.h

/// States of the supervisor, as status and recordings name them.
enum class State : std::uint8_t {
  starting,         ///< no valid reading from every channel yet; commands at rest, or where a fault left them
  idle,             ///< ready; nothing moves
  resynchronising,  ///< following the fingers to where they are before motion starts
  running,          ///< a sequence runs
  stopping,         ///< a sequence was stopped; the stop action is being carried out
  faulted,          ///< latched; outputs as the rig file says for the phase in which the fault came
};
[[nodiscard]] std::string_view name_of(State state) noexcept;
/// The rig moves because it was asked to: resynchronising, running or stopping.
[[nodiscard]] constexpr bool moves(State state) noexcept {
  return state == State::resynchronising || state == State::running || state == State::stopping;
}

/// A pressure may move away from rest: a sequence was started, and nothing has ended it.
[[nodiscard]] constexpr bool may_rise(State state) noexcept {
  return state == State::resynchronising || state == State::running;
}

/// Reason why a finger has not settled although a start needs it at rest: it moves, or it is off its model.
enum class UnsettledReason : std::uint8_t { none, moves, off_model };

/// How a sequence ended.
enum class SequenceEnd : std::uint8_t { done, failed, stopped, faulted };
[[nodiscard]] std::string_view name_of(SequenceEnd end) noexcept;

/// A request to the controller; at most one per tick (the loop queues them).
struct Request {
  enum class Kind : std::uint8_t {
    none,
    start,
    check,  ///< answered as a start would be now; nothing else comes of it
    stop,
    vent,
    acknowledge,
    release,
  };
  Kind kind = Kind::none;
  std::uint32_t id = 0;                        ///< echoed in the events that answer it
  const PreparedSequence* sequence = nullptr;  ///< for start, whose run it outlives, and check
  std::uint32_t of_start = 0;                  ///< for stop: the only start that it stops; 0: any
};

/// State of the bus since the last tick.
struct BusHealth {
  bool connected = false;             ///< a session is up
  FaultCode fault = FaultCode::none;  ///< what the last failed exchange means; none after a good one
  std::uint32_t consecutive_failures = 0;
  /// Counts how often the bus has stopped obeying: since then it writes nothing further from rest than
  /// TickInput::outputs_kpa,
  /// and `fault` says why, until commands come from a tick that knew this number.
  std::uint32_t inhibit = 0;
};

struct TickInput {
  Nanoseconds now = 0;
  std::span<const model::Reading> readings;  ///< one per channel
  BusHealth bus;
  /// One per channel: the pressure at the board's output, or one nearer to rest; empty: not known.
  std::span<const double> outputs_kpa;
  Request request;
  bool emergency_stop = false;       ///< the level of the input, true = stop
  bool interlock_open = false;       ///< a start is refused while true; opening it does not end a sequence
  bool inputs_lost = false;          ///< the digital inputs cannot be read, so their state is unknown
  std::uint32_t overrun_cycles = 0;  ///< cycles that the loop missed just before this tick
};

/// One channel in one tick. It is written in place: what the tick before left here is what this tick's
/// decisions are made from. Commands, a row of the recording and the status are taken from it.
struct ChannelOutput {
  double command_kpa = 0;      ///< what goes to the board: clamped and slew-limited
  double safe_kpa = 0;         ///< what to write instead when the loop sends no more, by the phase it is in
  double reference_mm = 0;     ///< clamped, for now; NaN while nothing is tracked
  double displacement_mm = 0;  ///< the reading used: the last valid one; NaN before the first
  double pressure_kpa = 0;     ///< measured, or NaN
  double temperature_c = 0;    ///< measured, or NaN; nothing depends on it
  double feedforward_kpa = 0;  ///< 0 while nothing is tracked
  double feedback_kpa = 0;     ///< 0 while nothing is tracked
  double residual_mm = 0;      ///< reading minus (model + offset), both at the time the reading was sampled;
                               ///< NaN while there is no valid reading
  double shortfall_mm = 0;     ///< how much less than its free-motion envelope the finger moved; NaN without
                               ///< sight and until the second valid reading in a row
  double free_kpa = 0;  ///< the command that the free finger needs to rest at this displacement; of the
                        ///< last valid reading
  /// gripping pressure that corresponds to the displacement shortfall; NaN without displacement feedback
  double squeeze_kpa = 0;
  double age_s = 0;          ///< of the reading
  double health_rms_mm = 0;  ///< root mean square of the residual; a large value makes the model unfit
  std::uint16_t step = 0;    ///< index in the sequence
  model::Validity validity = model::Validity::none_yet;
  GripResult result = GripResult::none;
  GripEvidence evidence = GripEvidence::none;  ///< on what the result rests
  HealthState health = HealthState::unknown;   ///< of the model
  bool health_changed = false;
  BindingLimit bound_by = BindingLimit::none;  ///< what kept the command noticeably from the request
  BindingLimit limit = BindingLimit::none;     ///< the same, when it has done so for longer than a moment
  bool saturated = false;                      ///< the request was outside the pressure range
  bool slewing = false;                        ///< the request was further away than the slew limits allow
  bool request_invalid = false;                ///< the request was not a number: the command was held
  bool reference_clamped = false;              ///< the reference was outside the displacement range
  bool out_of_reach = false;         ///< the feedforward cannot reach the reference within the limits
  bool stands_still = false;         ///< the reading repeats itself as this sensor never does
  bool unsteady = false;             ///< the reading jumps there and back, again and again
  double jump_mm = 0;                ///< how far it jumped last
  bool displacement_beyond = false;  ///< the reading is beyond the displacement range and its margin
  bool synchronised = false;         ///< resynchronising was asked and residual_mm has settled
};

/// `Event::channel` of what concerns the whole rig.
inline constexpr std::uint8_t whole_rig = 0xff;

/// A fault and its channel.
struct Fault {
  FaultCode code = FaultCode::none;
  std::uint8_t channel = whole_rig;
  double value = 0;  ///< value that belongs to it: an age, a displacement, a read-back, a number of cycles
};

/// An event to report; at most a few per tick.
struct Event {
  enum class Kind : std::uint8_t {
    state_changed,
    fault_latched,
    fault_acknowledged,
    sequence_started,
    sequence_finished,
    step_started,
    grip_result,
    request_refused,
    model_health_changed,
    reading_invalid,
    reading_valid,
    contact,           ///< a finger has touched something in a motion
    limit_binds,       ///< a limit has kept a command from what is wanted for longer than a moment
    limit_free,        ///< it does not any more
    release_asked,     ///< on with the release step
    reading_unsteady,  ///< the reading jumps there and back, again and again
    reading_steady,    ///< it has been calm for a while
    start_checked,     ///< a start would be accepted now
    not_at_rest,  ///< why a start found no rest. detail: UnsettledReason; value: model offset at rest [mm]
  };
  Kind kind = Kind::state_changed;
  std::uint8_t channel = whole_rig;
  /// State, FaultCode, GripResult, step, RefusalCode, HealthState, Validity, SequenceEnd, OnContact,
  /// BindingLimit or UnsettledReason, by kind.
  std::uint16_t detail = 0;
  std::uint32_t request = 0;  ///< the id of the request it answers, or 0
  /// value that belongs to it (a displacement shortfall, an age, a contact position), or 0
  double value = 0;
  GripEvidence evidence = GripEvidence::none;  ///< of grip_result: its basis
};

/// The events of one tick. Those that do not fit are counted.
class EventList {
 public:
  void add(const Event& event) noexcept {
    if (count_ < events_.size()) {
      events_[count_++] = event;
    } else {
      ++lost_;
    }
  }
  /// `detail` is one of the enumerations that Event::detail names.
  template <class Detail>
  void add(Event::Kind kind, Detail detail, std::uint32_t request = 0, double value = 0) noexcept {
    add_of_channel(whole_rig, kind, detail, request, value);
  }
  template <class Detail>
  void add_of_channel(std::size_t channel, Event::Kind kind, Detail detail, std::uint32_t request = 0,
                      double value = 0) noexcept {
    add({kind, static_cast<std::uint8_t>(channel), static_cast<std::uint16_t>(detail), request, value,
         GripEvidence::none});
  }
  void clear() noexcept { count_ = lost_ = 0; }

  [[nodiscard]] const Event* begin() const noexcept { return events_.data(); }
  [[nodiscard]] const Event* end() const noexcept { return events_.data() + count_; }
  [[nodiscard]] std::uint32_t lost() const noexcept { return lost_; }

 private:
  std::uint32_t count_ = 0;
  std::uint32_t lost_ = 0;
  std::array<Event, 16> events_{};
};

struct TickOutput {
  State state = State::starting;
  Fault first_fault;  ///< the first that latched
  Fault cause;        ///< what is there in this tick and is a fault or grows to one
  /// Channels whose command stays away from rest although nothing moves: behind a sequence that ended in
  /// a hold, after a stop or a fault that holds. Bit i is channel i.
  std::uint32_t under_pressure = 0;
  std::size_t channel_count = 0;
  std::array<ChannelOutput, max_channels> channels{};
  EventList events;
};

}  // namespace softgrip::control
