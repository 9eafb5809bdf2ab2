#pragma once
// Everything that happens in one tick between readings and commands: the seam between control and the loop.
// The same object runs in softgripd, in `softgrip run`, in virtual time, in tests and in benchmarks.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "control/elements/fault.h"
#include "control/elements/grip_result.h"
#include "control/elements/model_health.h"
#include "control/tick/settings.h"
#include "model/reading.h"

namespace softgrip::control {

struct PreparedSequence;  // control/tick/sequence.h

/// States of the supervisor, as status and recordings name them.
enum class State : std::uint8_t {
  starting,  ///< no valid reading from every channel yet; commands at the lowest, or where a fault left them
  idle,      ///< ready; nothing moves
  resynchronising,  ///< following the fingers to where they are before motion starts
  running,          ///< a sequence runs
  stopping,         ///< a sequence was stopped; the stop action is being carried out
  faulted,          ///< latched; outputs as the rig file says for the phase in which the fault came
};
[[nodiscard]] std::string_view name_of(State state) noexcept;

/// How a sequence ended.
enum class SequenceEnd : std::uint8_t { done, failed, stopped, faulted };
[[nodiscard]] std::string_view name_of(SequenceEnd end) noexcept;

/// What the outside may ask of the controller; at most one per tick (the loop queues them).
struct Request {
  enum class Kind : std::uint8_t { none, start, stop, vent, acknowledge };
  Kind kind = Kind::none;
  std::uint32_t id = 0;                        ///< echoed in the events that answer it
  const PreparedSequence* sequence = nullptr;  ///< for start; outlives its run
};

/// What the bus did since the last tick, as far as control must know.
struct BusHealth {
  bool connected = false;             ///< a session is up
  FaultCode fault = FaultCode::none;  ///< what the last failed exchange means; none after a good one
  std::uint32_t consecutive_failures = 0;
};

struct TickInput {
  Nanoseconds now = 0;
  std::span<const model::Reading> readings;  ///< one per channel
  BusHealth bus;
  Request request;
  bool emergency_stop = false;       ///< the level of the input, true = stop
  bool interlock_open = false;       ///< a start is refused while true; opening it does not end a sequence
  bool inputs_lost = false;          ///< the digital inputs cannot be read: nobody knows what they say
  std::uint32_t slipped_cycles = 0;  ///< cycles that the loop lost just before this tick
};

/// One channel after a tick; a row of the recording.
struct ChannelOutput {
  double command_kpa = 0;      ///< what goes to the board: clamped and slew-limited
  double reference_mm = 0;     ///< NaN while nothing is tracked
  double displacement_mm = 0;  ///< the reading used
  double pressure_kpa = 0;     ///< measured, or NaN
  double feedforward_kpa = 0;
  double feedback_kpa = 0;
  double residual_mm = 0;  ///< reading minus the running model
  double age_s = 0;        ///< of the reading
  model::Validity validity = model::Validity::none_yet;
  GripResult result = GripResult::none;
  GripEvidence evidence = GripEvidence::none;  ///< on what the result rests
  double deficit_mm = 0;   ///< how much less than its free-motion envelope the finger moved
  std::uint16_t step = 0;  ///< index in the sequence
  bool saturated = false;
  bool slewing = false;
  HealthState health = HealthState::unknown;  ///< of the model
  double health_rms_mm = 0;                   ///< of the residual, by which a model is unfit
};

/// Something worth telling, at most a few per tick.
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
  };
  Kind kind = Kind::state_changed;
  std::uint8_t channel = 0xff;  ///< 0xff: the whole rig
  std::uint16_t detail =
      0;  ///< State, FaultCode, GripResult, step, RefusalCode HealthState or SequenceEnd, by kind
  std::uint32_t request = 0;                   ///< the id of the request it answers, or 0
  double value = 0;                            ///< a number that goes with it (a deficit, an age), or 0
  GripEvidence evidence = GripEvidence::none;  ///< of grip_result: on what it rests
};

struct TickOutput {
  State state = State::starting;
  FaultCode first_fault = FaultCode::none;  ///< the first that latched
  std::size_t channel_count = 0;
  std::array<ChannelOutput, max_channels> channels{};
  std::size_t event_count = 0;
  std::array<Event, 16> events{};
  std::uint32_t events_lost = 0;  ///< that did not fit
};

/// The rig's control. Construction may allocate and throws nothing that is not std::bad_alloc: settings were
/// checked by settings_problems(). tick() allocates nothing, calls nothing of the system, cannot fail.
class RigController {
 public:
  explicit RigController(const RigSettings& settings);
  RigController(const RigController&) = delete;
  RigController& operator=(const RigController&) = delete;
  RigController(RigController&&) noexcept;
  RigController& operator=(RigController&&) noexcept;
  ~RigController();

  /// One period of 1/settings.rate_hz.
  void tick(const TickInput& input, TickOutput& output) noexcept;

  /// The command of every channel for leaving the loop now (stop, signal, exception), by the phase it is in.
  void safe_commands(std::span<double> commands_kpa) const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::control
