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

struct PreparedSequence;  // defined in control/tick/sequence.h

/// States of the supervisor; status and recordings use these names.
enum class State : std::uint8_t {
  starting,         ///< not all channels have a valid reading yet; the commands are at rest, or as a fault
                    ///< left them
  idle,             ///< ready; nothing moves
  resynchronising,  ///< a start was accepted: waits for rest and adjusts the models to the readings
  running,          ///< a sequence runs
  stopping,         ///< a sequence was stopped; the stop action is in progress
  faulted,          ///< a fault is latched; outputs as the rig file states for the phase in which it occurred
};
[[nodiscard]] std::string_view name_of(State state) noexcept;
/// Returns true if the rig moves after a request: resynchronising, running or stopping.
[[nodiscard]] constexpr bool moves(State state) noexcept {
  return state == State::resynchronising || state == State::running || state == State::stopping;
}

/// Returns true if a pressure may move away from rest: a sequence was started and has not ended.
[[nodiscard]] constexpr bool may_rise(State state) noexcept {
  return state == State::resynchronising || state == State::running;
}

/// Reason why a finger has not settled although a start needs it at rest: the finger moves, or its reading
/// differs from the model.
enum class UnsettledReason : std::uint8_t { none, moves, off_model };

/// The reason why a sequence ended.
enum class SequenceEnd : std::uint8_t { done, failed, stopped, faulted };
[[nodiscard]] std::string_view name_of(SequenceEnd end) noexcept;

/// A request to the controller; at most one per tick (the loop queues them).
struct Request {
  enum class Kind : std::uint8_t {
    none,
    start,
    check,  ///< answered like a start at this time, but without another effect
    stop,
    vent,
    acknowledge,
    release,
  };
  Kind kind = Kind::none;
  std::uint32_t id = 0;                        ///< repeated in the events that answer the request
  const PreparedSequence* sequence = nullptr;  ///< for start and check; must outlive the run
  std::uint32_t of_start = 0;                  ///< for stop: id of the one start to stop; 0: any
};

/// State of the bus since the last tick.
struct BusHealth {
  bool connected = false;             ///< a session is open
  FaultCode fault = FaultCode::none;  ///< cause of the last failed exchange; none after a successful one
  std::uint32_t consecutive_failures = 0;
  /// Number of times that the bus thread has stopped applying the commands. After an increase, it writes no
  /// pressure that is further from rest than TickInput::outputs_kpa, and `fault` gives the reason. It applies
  /// commands again when they come from a tick that has read the new number.
  std::uint32_t inhibit = 0;
};

struct TickInput {
  Nanoseconds now = 0;
  std::span<const model::Reading> readings;  ///< one per channel
  BusHealth bus;
  /// One value per channel: the pressure at the board's output, or a pressure that is nearer to rest. Empty:
  /// unknown.
  std::span<const double> outputs_kpa;
  Request request;
  bool emergency_stop = false;       ///< the level of the input, true = stop
  bool interlock_open = false;       ///< a start is refused while true; a sequence with Interlock::always is
                                     ///< stopped
  bool inputs_lost = false;          ///< the digital inputs cannot be read, so their state is unknown
  std::uint32_t overrun_cycles = 0;  ///< cycles that the loop missed just before this tick
};

/// One channel in one tick. It is changed in place: the values of the last tick are the basis of the
/// decisions of this tick. Commands, rows of the recording and the status are copied from it.
struct ChannelOutput {
  double command_kpa = 0;      ///< command for the board: within the range and the slew limits
  double safe_kpa = 0;         ///< command if the loop stops now; it depends on the phase
  double reference_mm = 0;     ///< limited reference at the time of this tick; NaN without tracking
  double displacement_mm = 0;  ///< last valid reading; NaN before the first one
  double pressure_kpa = 0;     ///< measured pressure, or NaN
  double temperature_c = 0;    ///< measured temperature, or NaN; only recorded
  double feedforward_kpa = 0;  ///< feedforward part of the request; 0 without tracking
  double feedback_kpa = 0;     ///< feedback part of the request; 0 without tracking
  double residual_mm = 0;      ///< reading minus (model + offset) at the time of the reading; NaN without a
                               ///< reading
  double shortfall_mm = 0;     ///< displacement shortfall against free motion; NaN if it is unknown
  double free_kpa = 0;         ///< command under which the free finger rests at the last valid reading
  /// gripping pressure that corresponds to the displacement shortfall; NaN without displacement feedback
  double squeeze_kpa = 0;
  double age_s = 0;          ///< age of the reading
  double health_rms_mm = 0;  ///< root mean square of the residual; a large value makes the model unfit
  std::uint16_t step = 0;    ///< index in the sequence
  model::Validity validity = model::Validity::none_yet;
  GripResult result = GripResult::none;
  GripEvidence evidence = GripEvidence::none;  ///< evidence for the result
  HealthState health = HealthState::unknown;   ///< state of the model
  bool health_changed = false;
  BindingLimit bound_by = BindingLimit::none;  ///< limit because of which the command differs noticeably from
                                               ///< the request
  BindingLimit limit = BindingLimit::none;     ///< the same limit, after it has been active for
                                               ///< LimitWatch::moment_s
  bool saturated = false;                      ///< the request was outside the pressure range
  bool slewing = false;                        ///< the request was further from the last command than the
                                               ///< slew limits allow
  bool request_invalid = false;                ///< the request was not a number: the command was held
  bool reference_clamped = false;              ///< the reference was outside the displacement range
  bool out_of_reach = false;         ///< the feedforward cannot reach the reference within the limits
  bool stands_still = false;         ///< the reading is constant for an implausible time for this sensor
  bool unsteady = false;             ///< the reading jumps back and forth repeatedly
  double jump_mm = 0;                ///< last jump; the sign is the direction
  bool displacement_beyond = false;  ///< the reading is outside the displacement range and its margin
  bool synchronised = false;         ///< resynchronisation was requested and residual_mm has settled
};

/// `Event::channel` of events that concern the complete rig.
inline constexpr std::uint8_t whole_rig = 0xff;

/// A fault and its channel.
struct Fault {
  FaultCode code = FaultCode::none;
  std::uint8_t channel = whole_rig;
  double value = 0;  ///< value of the condition: an age, a displacement, a read-back, a number of cycles
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
    contact,           ///< a finger has come into contact during a motion
    limit_binds,       ///< a limit has restricted a command for longer than LimitWatch::moment_s
    limit_free,        ///< the limit no longer restricts the command
    release_asked,     ///< the sequence continues with the release step
    reading_unsteady,  ///< the reading jumps back and forth repeatedly
    reading_steady,    ///< the reading has not jumped for JumpWatch::calm_s
    start_checked,     ///< a start would be accepted now
    not_at_rest,       ///< reason why a start found no rest. detail: UnsettledReason; value: model offset
                       ///< [mm]
  };
  Kind kind = Kind::state_changed;
  std::uint8_t channel = whole_rig;
  /// State, FaultCode, GripResult, step, RefusalCode, HealthState, Validity, SequenceEnd, OnContact,
  /// BindingLimit or UnsettledReason, depending on `kind`.
  std::uint16_t detail = 0;
  std::uint32_t request = 0;  ///< id of the request that the event answers, or 0
  /// value of the event (a displacement shortfall, an age, a contact position), or 0
  double value = 0;
  GripEvidence evidence = GripEvidence::none;  ///< of grip_result: its evidence
};

/// The events of one tick. Events beyond the capacity are not stored, but counted.
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
  Fault first_fault;  ///< first fault that latched
  Fault cause;        ///< present condition that is a fault or may become one
  /// Channels under pressure without motion: after a sequence that ended in a hold, or after a stop or a
  /// fault with the action hold. Bit i is channel i.
  std::uint32_t under_pressure = 0;
  std::size_t channel_count = 0;
  std::array<ChannelOutput, max_channels> channels{};
  EventList events;
};

}  // namespace softgrip::control
