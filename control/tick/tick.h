#pragma once
// Defines the inputs and outputs of RigController (control/tick/rig_controller.h) for one tick. The outputs
// contain no allocated memory, so one thread can copy them to another.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "control/elements/fault.h"
#include "control/elements/grip_result.h"
#include "control/elements/limit_watch.h"
#include "control/elements/model_health.h"
#include "control/tick/settings.h"
#include "model/reading.h"

namespace softgrip::control {

struct PreparedSequence;              // control/tick/sequence.h defines this struct
enum class OnContact : std::uint8_t;  // control/tick/sequence.h defines this enum

/// States of the supervisor. Status and recordings use the names of these states.
enum class State : std::uint8_t {
  starting,         ///< not every channel has a valid reading yet; the commands are the rest pressures, or
                    ///< the commands after a fault
  idle,             ///< the rig is ready, and nothing moves
  resynchronising,  ///< a start was accepted; the controller waits until the fingers are at rest, and adjusts
                    ///< the models to the readings
  running,          ///< a sequence runs
  stopping,  ///< channels go to their rest pressure because of a stop, a vent, a release or the end of a
             ///< sequence
  faulted,   ///< a fault is latched; the outputs follow the action that the rig file gives for the
             ///< phase of the fault
};
[[nodiscard]] std::string_view name_of(State state) noexcept;
/// Returns true if the rig moves or may start to move by itself in this state: resynchronising, running or
/// stopping.
[[nodiscard]] constexpr bool moves(State state) noexcept {
  return state == State::resynchronising || state == State::running || state == State::stopping;
}

/// Returns true if a pressure may move away from the rest pressure in this state, because a sequence was
/// started and has not ended.
[[nodiscard]] constexpr bool may_rise(State state) noexcept {
  return state == State::resynchronising || state == State::running;
}

/// The reason why a finger is not ready for a start: the finger moves, or its reading at rest differs from
/// the model.
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
    check,  ///< tests if a start would be accepted at this time; the rig does not start
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
  std::uint32_t of_start = 0;                  ///< for stop: id of the start that must stop; 0: any running
                                               ///< start must stop
};

/// State of the bus, from the exchanges since the last tick.
struct BusHealth {
  bool connected = false;             ///< true: a connection to the board is open
  FaultCode fault = FaultCode::none;  ///< cause of the last failed exchange; `none` after a successful
                                      ///< exchange
  std::uint32_t consecutive_failures = 0;
  /// Number of times that the bus thread has stopped applying the commands; `fault` gives the reason. After
  /// such a stop, the bus thread writes no pressure that is further from rest than TickInput::outputs_kpa.
  /// The bus thread applies the commands of a tick again after this tick has read the new value of `inhibit`.
  std::uint32_t inhibit = 0;
};

struct TickInput {
  Nanoseconds now = 0;
  std::span<const model::Reading> readings;  ///< newest reading of each channel
  BusHealth bus;
  /// For each channel, the pressure at the board's output, or a pressure between this pressure and the rest
  /// pressure. Empty: the outputs are unknown.
  std::span<const double> outputs_kpa;
  Request request;
  bool emergency_stop = false;       ///< state of the emergency stop input; true: stop
  bool interlock_open = false;       ///< true: a start is refused, and a sequence with Interlock::always is
                                     ///< stopped
  bool inputs_lost = false;          ///< true: the digital inputs cannot be read, so their state is unknown
  std::uint32_t overrun_cycles = 0;  ///< number of cycles that the loop missed just before this tick
};

/// The output of one channel in one tick. A tick starts with the output of the previous tick and changes it,
/// because some decisions depend on the previous values. The commands for the board, the rows of the
/// recording and the status are copied from this output.
struct ChannelOutput {
  double command_kpa = 0;      ///< command for the board, within the pressure range and the slew limits
  double safe_kpa = 0;         ///< command that is written if the loop stops now; the command depends on the
                               ///< phase of the rig
  double reference_mm = 0;     ///< reference at the time of this tick, limited to the displacement range; NaN
                               ///< if no reference is followed
  double displacement_mm = 0;  ///< last valid reading; NaN before the first valid reading
  double pressure_kpa = 0;     ///< measured pressure; NaN if no pressure is measured
  double temperature_c = 0;    ///< measured temperature, which is recorded but not used; NaN if no
                               ///< temperature is measured
  double feedforward_kpa = 0;  ///< feedforward part of the requested command; 0 if no reference is followed
  double feedback_kpa = 0;     ///< feedback part of the requested command; 0 if no reference is followed
  double residual_mm = 0;      ///< reading minus (model output + offset) at the time of the reading; NaN
                               ///< without a reading
  double offset_mm = 0;        ///< offset that resynchronisation has added to the model
  double shortfall_mm = 0;     ///< displacement of free motion minus reading; NaN if the shortfall is unknown
  double free_kpa = 0;         ///< command under which the free finger rests at the last valid reading
  double squeeze_kpa = 0;    ///< gripping pressure: command under which the free finger rests at the model's
                             ///< displacement, minus that command for the reading; NaN without a valid
                             ///< reading
  double age_s = 0;          ///< age of the reading in this tick
  double health_rms_mm = 0;  ///< root mean square of the residual; above unfit_mm, the model is unfit
  std::uint16_t step = 0;    ///< index of the step in the sequence
  model::Validity validity = model::Validity::none_yet;
  GripResult result = GripResult::none;
  GripEvidence evidence = GripEvidence::none;  ///< evidence on which the grip result is based
  HealthState health =
      HealthState::unknown;  ///< health of the channel's model: healthy, suspect, unfit or unknown
  bool health_changed = false;
  BindingLimit bound_by = BindingLimit::none;  ///< limit that changes the command by more than 0.5 kPa from
                                               ///< the request
  BindingLimit limit = BindingLimit::none;     ///< value of bound_by after it has restricted the command for
                                               ///< LimitWatch::moment_s
  bool saturated = false;                      ///< true: the requested command was outside the pressure range
  bool slewing = false;                        ///< true: the requested command was further from the last
                                               ///< command than the slew limits allow
  bool request_invalid = false;                ///< true: the requested command was not a number, so the last
                                               ///< command was held
  bool reference_clamped = false;              ///< true: the reference was outside the displacement range, so
                                               ///< it was limited
  bool out_of_reach = false;         ///< true: the feedforward cannot reach the reference within the limits
  bool stands_still = false;         ///< true: the reading has been constant for an implausibly long time for
                                     ///< this sensor
  bool unsteady = false;             ///< true: the reading jumps back and forth repeatedly
  double jump_mm = 0;                ///< size of the last jump of the reading; negative for a decrease
  bool displacement_beyond = false;  ///< true: the reading is outside the displacement range and outside the
                                     ///< margin around this range
  bool synchronised = false;         ///< true: resynchronisation was requested, and residual_mm has settled
};

/// Value of `Event::channel` for an event that concerns the complete rig.
inline constexpr std::uint8_t whole_rig = 0xff;

/// A fault and the channel in which it occurred.
struct Fault {
  FaultCode code = FaultCode::none;
  std::uint8_t channel = whole_rig;
  double value = 0;  ///< value of the fault condition: for example an age, a displacement, a read-back or a
                     ///< number of cycles
};

/// The new grip result of a channel, and the evidence on which it is based.
struct GripAnswer {
  GripResult result = GripResult::none;
  GripEvidence evidence = GripEvidence::none;
  bool operator==(const GripAnswer&) const = default;
};

/// The reason why a request was refused. For RefusalCode::cause_persists, `cause` is the fault condition that
/// is still present.
struct RequestRefusal {
  RefusalCode code = RefusalCode::none;
  FaultCode cause = FaultCode::none;
  bool operator==(const RequestRefusal&) const = default;
};

/// An event that the daemon must report. A tick has at most a few events.
struct Event {
  enum class Kind : std::uint8_t {
    state_changed,
    fault_latched,
    fault_acknowledged,
    sequence_started,
    sequence_finished,
    step_started,  ///< `value` is the number of retries of the step
    grip_result,   ///< `value` is the displacement shortfall [mm]
    request_refused,
    model_health_changed,  ///< `value` is the root mean square of the residual [mm]
    reading_invalid,       ///< `value` is the age of the reading [s]
    reading_valid,
    contact,           ///< a finger has come into contact with an object during a motion; `value` is the
                       ///< displacement [mm]
    limit_binds,       ///< a limit has restricted a command for longer than LimitWatch::moment_s; `value` is
                       ///< the command [kPa]
    limit_free,        ///< the limit that was reported by limit_binds no longer restricts the command
    release_asked,     ///< a release was requested, so the sequence continues with its release step
    reading_unsteady,  ///< the reading jumps back and forth repeatedly; `value` is the last jump [mm]
    reading_steady,    ///< the reading has not jumped for JumpWatch::calm_s
    start_checked,     ///< the result of a request of the kind `check`: a start would be accepted now
    not_at_rest,  ///< a start was aborted, because a finger moved or deviated from its model at rest; `value`
                  ///< is the model offset [mm]
  };
  /// The detail of an event. DetailOf gives the type for each kind. The integer is the index of a step.
  using Detail =
      std::variant<std::monostate, State, FaultCode, SequenceEnd, std::uint16_t, GripAnswer, RequestRefusal,
                   HealthState, model::Validity, OnContact, BindingLimit, UnsettledReason>;

  Kind kind = Kind::state_changed;
  std::uint8_t channel = whole_rig;
  Detail detail;
  std::uint32_t request = 0;  ///< id of the request that the event answers; 0 if the event answers no request
  double value = 0;           ///< number of the event; 0 for an event without a number
};
// The loop copies events to other threads through a ring buffer.
static_assert(std::is_trivially_copyable_v<Event> && sizeof(Event) == 24);

/// Returns the type of the detail of an event of the kind `kind`; std::monostate for an event without detail.
template <Event::Kind kind>
[[nodiscard]] consteval auto type_of_detail() noexcept {
  using enum Event::Kind;
  if constexpr (kind == state_changed) {
    return std::type_identity<State>();
  } else if constexpr (kind == fault_latched || kind == fault_acknowledged) {
    return std::type_identity<FaultCode>();
  } else if constexpr (kind == sequence_finished) {
    return std::type_identity<SequenceEnd>();
  } else if constexpr (kind == step_started) {
    return std::type_identity<std::uint16_t>();
  } else if constexpr (kind == grip_result) {
    return std::type_identity<GripAnswer>();
  } else if constexpr (kind == request_refused) {
    return std::type_identity<RequestRefusal>();
  } else if constexpr (kind == model_health_changed) {
    return std::type_identity<HealthState>();
  } else if constexpr (kind == reading_invalid || kind == reading_valid) {
    return std::type_identity<model::Validity>();
  } else if constexpr (kind == contact) {
    return std::type_identity<OnContact>();
  } else if constexpr (kind == limit_binds || kind == limit_free) {
    return std::type_identity<BindingLimit>();
  } else if constexpr (kind == not_at_rest) {
    return std::type_identity<UnsettledReason>();
  } else {
    return std::type_identity<std::monostate>();
  }
}
template <Event::Kind kind>
using DetailOf = typename decltype(type_of_detail<kind>())::type;

/// The events of one tick. If the list is full, further events are counted, but not stored.
class EventList {
 public:
  /// Adds an event that concerns the complete rig.
  template <Event::Kind kind>
  void add(DetailOf<kind> detail, std::uint32_t request = 0, double value = 0) noexcept {
    add_of_channel<kind>(whole_rig, detail, request, value);
  }
  /// Adds an event of a channel.
  template <Event::Kind kind>
  void add_of_channel(std::size_t channel, DetailOf<kind> detail, std::uint32_t request = 0,
                      double value = 0) noexcept {
    if (count_ < events_.size()) {
      events_[count_++] = {.kind = kind,
                           .channel = static_cast<std::uint8_t>(channel),
                           .detail = detail,
                           .request = request,
                           .value = value};
    } else {
      ++lost_;
    }
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
  Fault cause;        ///< present condition that is a fault, or becomes a fault if it lasts long enough
  /// Bit mask of the channels that are under pressure but do not move; bit i is channel i. This is the case
  /// after a sequence that ended with the action hold, and after a stop or a fault with the action hold.
  std::uint32_t under_pressure = 0;
  std::size_t channel_count = 0;
  std::array<ChannelOutput, max_channels> channels{};
  EventList events;
};

}  // namespace softgrip::control
