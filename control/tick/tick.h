#pragma once
// Defines the inputs and outputs of RigController (control/tick/rig_controller.h) for one tick. They are
// plain values without allocated memory, so threads can copy them.

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

struct PreparedSequence;  // control/tick/sequence.h defines this struct

/// States of the supervisor. Status and recordings use the names of these states.
enum class State : std::uint8_t {
  starting,         ///< not all channels have a valid reading yet; the commands are the rest pressures, or
                    ///< the commands after a fault
  idle,             ///< the rig is ready, and nothing moves
  resynchronising,  ///< a start was accepted; waits until the fingers are at rest, and adjusts the models to
                    ///< the readings
  running,          ///< a sequence runs
  stopping,         ///< a sequence was stopped; the stop action is not finished yet
  faulted,          ///< a fault is latched; the rig file gives the outputs for the phase in which the fault
                    ///< occurred
};
[[nodiscard]] std::string_view name_of(State state) noexcept;
/// Returns true if a request makes the rig move in this state: resynchronising, running or stopping.
[[nodiscard]] constexpr bool moves(State state) noexcept {
  return state == State::resynchronising || state == State::running || state == State::stopping;
}

/// Returns true if a pressure may move away from rest in this state: a sequence was started and has not
/// ended.
[[nodiscard]] constexpr bool may_rise(State state) noexcept {
  return state == State::resynchronising || state == State::running;
}

/// The reason why a finger has not settled, although a start needs it at rest. Either the finger moves, or
/// its reading differs from the model.
enum class UnsettledReason : std::uint8_t { none, moves, off_model };

/// The reason why a sequence ended.
enum class SequenceEnd : std::uint8_t { done, failed, stopped, faulted };
[[nodiscard]] std::string_view name_of(SequenceEnd end) noexcept;

/// A request to the controller. Each tick gets at most one request; the loop stores the other requests in a
/// queue.
struct Request {
  enum class Kind : std::uint8_t {
    none,
    start,
    check,  ///< the reply is the same as for a start at this time, but the rig does not start
    stop,
    vent,
    acknowledge,
    release,
  };
  Kind kind = Kind::none;
  std::uint32_t id = 0;                        ///< id of the request; the events that answer the request
                                               ///< contain it
  const PreparedSequence* sequence = nullptr;  ///< for start and check; must exist until the sequence has
                                               ///< ended
  std::uint32_t of_start = 0;                  ///< for stop: id of the only start that must stop; 0: any
                                               ///< start
};

/// State of the bus in the time since the last tick.
struct BusHealth {
  bool connected = false;             ///< true: a connection to the board is open
  FaultCode fault = FaultCode::none;  ///< cause of the last failed exchange; `none` after a successful
                                      ///< exchange
  std::uint32_t consecutive_failures = 0;
  /// Number of times that the bus thread has stopped applying the commands. After such a stop, the bus thread
  /// writes no pressure that is further from rest than TickInput::outputs_kpa, and `fault` gives the reason.
  /// The bus thread applies commands again when they come from a tick that has read the new number.
  std::uint32_t inhibit = 0;
};

struct TickInput {
  Nanoseconds now = 0;
  std::span<const model::Reading> readings;  ///< newest reading of each channel
  BusHealth bus;
  /// For each channel, the pressure at the board's output or a pressure that is nearer to rest. Empty:
  /// unknown.
  std::span<const double> outputs_kpa;
  Request request;
  bool emergency_stop = false;       ///< state of the emergency stop input; true: stop
  bool interlock_open = false;       ///< true: a start is refused, and a sequence with Interlock::always is
                                     ///< stopped
  bool inputs_lost = false;          ///< true: the digital inputs cannot be read, so their state is unknown
  std::uint32_t overrun_cycles = 0;  ///< number of cycles that the loop missed just before this tick
};

/// The output of one channel in one tick. Each tick modifies the output of the previous tick, because a tick
/// decides on the basis of the previous values. The commands, the rows of the recording and the status are
/// copied from this output.
struct ChannelOutput {
  double command_kpa = 0;      ///< command for the board, within the pressure range and the slew limits
  double safe_kpa = 0;         ///< command that is written if the loop stops now; it depends on the phase
  double reference_mm = 0;     ///< limited reference at the time of this tick; NaN if no reference is
                               ///< followed
  double displacement_mm = 0;  ///< last valid reading; NaN before the first one
  double pressure_kpa = 0;     ///< measured pressure; NaN if it is not measured
  double temperature_c = 0;    ///< measured temperature; NaN if it is not measured; it is recorded, but not
                               ///< used
  double feedforward_kpa = 0;  ///< feedforward part of the request; 0 if no reference is followed
  double feedback_kpa = 0;     ///< feedback part of the request; 0 if no reference is followed
  double residual_mm = 0;      ///< reading minus (model output + offset) at the time of the reading; NaN
                               ///< without a reading
  double shortfall_mm = 0;     ///< displacement of free motion minus reading; NaN if it is unknown
  double free_kpa = 0;         ///< command under which the free finger rests at the last valid reading
  /// gripping pressure: the pressure above free_kpa; NaN without displacement feedback
  double squeeze_kpa = 0;
  double age_s = 0;          ///< age of the reading in this tick
  double health_rms_mm = 0;  ///< root mean square of the residual; above a limit, the model is unfit
  std::uint16_t step = 0;    ///< index of the step in the sequence
  model::Validity validity = model::Validity::none_yet;
  GripResult result = GripResult::none;
  GripEvidence evidence = GripEvidence::none;  ///< evidence on which the grip result is based
  HealthState health =
      HealthState::unknown;  ///< health of the channel's model: healthy, suspect, unfit or unknown
  bool health_changed = false;
  BindingLimit bound_by = BindingLimit::none;  ///< limit that changes the command noticeably compared with
                                               ///< the request
  BindingLimit limit = BindingLimit::none;     ///< limit bound_by, after it has been active for
                                               ///< LimitWatch::moment_s
  bool saturated = false;                      ///< true: the request was outside the pressure range
  bool slewing = false;                        ///< true: the request was further from the last command than
                                               ///< the slew limits allow
  bool request_invalid = false;                ///< true: the request was not a number, so the last command
                                               ///< was held
  bool reference_clamped = false;              ///< true: the reference was outside the displacement range, so
                                               ///< it was limited
  bool out_of_reach = false;         ///< true: the feedforward cannot reach the reference within the limits
  bool stands_still = false;         ///< true: the reading has been constant for a time that is implausible
                                     ///< for this sensor
  bool unsteady = false;             ///< true: the reading jumps back and forth repeatedly
  double jump_mm = 0;                ///< size of the last jump; the sign gives the direction
  bool displacement_beyond = false;  ///< true: the reading is outside the displacement range and the margin
                                     ///< around the range
  bool synchronised = false;         ///< true: resynchronisation was requested, and residual_mm has settled
};

/// Value of `Event::channel` for an event that concerns the complete rig.
inline constexpr std::uint8_t whole_rig = 0xff;

/// A fault, and the channel that it concerns.
struct Fault {
  FaultCode code = FaultCode::none;
  std::uint8_t channel = whole_rig;
  double value = 0;  ///< value of the fault condition: an age, a displacement, a read-back or a number of
                     ///< cycles
};

/// An event that the daemon must report. A tick has at most a few events.
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
    contact,           ///< a finger has come into contact with an object during a motion
    limit_binds,       ///< a limit has restricted a command for longer than LimitWatch::moment_s
    limit_free,        ///< the limit that was reported no longer restricts the command
    release_asked,     ///< the sequence continues with its release step
    reading_unsteady,  ///< the reading jumps back and forth repeatedly
    reading_steady,    ///< the reading has not jumped for JumpWatch::calm_s
    start_checked,     ///< the result of a check: a start would be accepted now
    not_at_rest,       ///< the reason why a start found no rest. `detail` is an UnsettledReason; `value` is
                       ///< the model offset [mm]
  };
  Kind kind = Kind::state_changed;
  std::uint8_t channel = whole_rig;
  /// Detail of the event. Its type depends on `kind`: State, FaultCode, GripResult, step, RefusalCode,
  /// HealthState, Validity, SequenceEnd, OnContact, BindingLimit or UnsettledReason.
  std::uint16_t detail = 0;
  std::uint32_t request = 0;  ///< id of the request that the event answers; 0 if there is none
  /// Value of the event (a displacement shortfall, an age, a contact position); 0 if there is none.
  double value = 0;
  GripEvidence evidence = GripEvidence::none;  ///< for a grip result: the evidence on which it is based
};

/// The events of one tick. Events beyond the capacity of the list are counted, but not stored.
class EventList {
 public:
  void add(const Event& event) noexcept {
    if (count_ < events_.size()) {
      events_[count_++] = event;
    } else {
      ++lost_;
    }
  }
  /// Adds an event that concerns the complete rig. `detail` is a value of one of the enumerations that
  /// Event::detail names.
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
  Fault first_fault;  ///< the fault that latched first
  Fault cause;        ///< present condition that is a fault, or can become a fault if it lasts
  /// Channels that are under pressure but do not move: after a sequence that ended in a hold, or after a stop
  /// or a fault with the action hold. Bit i is channel i.
  std::uint32_t under_pressure = 0;
  std::size_t channel_count = 0;
  std::array<ChannelOutput, max_channels> channels{};
  EventList events;
};

}  // namespace softgrip::control
