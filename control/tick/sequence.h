#pragma once
// Defines grip sequences in two forms: as written in the file (Sequence), and fitted to one rig
// (PreparedSequence). The members have the names of the keys in the file; docs/reference/sequence-file.md
// describes the keys.
// Defines the parameters of a sequence. A parameter is a number whose value a start request may choose.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/enum_table.h"
#include "control/feedforward/pressure_plan.h"
#include "control/tick/settings.h"
#include "document/problem.h"
#include "model/signals.h"

namespace softgrip::control {

/// Value of an unlimited time, and of a pressure bound that the file does not give.
inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// Returns a bit mask that contains only the channel `channel`.
constexpr std::uint32_t channel_bit(std::size_t channel) noexcept {
  return 1U << channel;
}

/// A number that a sequence file declares under `parameters` and uses as `$name`.
struct Parameter {
  std::string name;
  std::string unit;  ///< unit, spelled as at the end of keys: "kpa", "mm_per_s"; empty for a number without a
                     ///< unit
  double lower = 0;  ///< smallest allowed value; `upper` is the largest allowed value
  double upper = 0;
  double default_value = 0;
  std::string about;      ///< description of the parameter in one sentence
  document::Location at;  ///< position of the parameter's name in the file
  double value = 0;       ///< value with which the sequence is read; at first the default
};

/// A value that a start request assigns to a parameter, in the unit of the parameter.
struct Argument {
  std::string name;
  double value = 0;
  bool operator==(const Argument&) const = default;
};

/// The kind of a step. The name of a kind is the key of the step in the file.
enum class StepKind : std::uint8_t {
  move,  ///< moves to a target along a ramp
  grip,  ///< moves to a target, then verifies the grip: HOLDING or NO PART
  hold,  ///< keeps the target of the previous step and verifies the grip repeatedly; result PART LOST if the
         ///< object is lost
  release,   ///< moves towards the rest pressure, then stays at the rest pressure for purge_s: result
             ///< RELEASED
  track,     ///< follows a displacement over time with feedback; used in studies
  pressure,  ///< follows a pressure over time without feedback; used in experiments
};
inline constexpr auto step_names = enum_names<StepKind>({{StepKind::move, "move"},
                                                         {StepKind::grip, "grip"},
                                                         {StepKind::hold, "hold"},
                                                         {StepKind::release, "release"},
                                                         {StepKind::track, "track"},
                                                         {StepKind::pressure, "pressure"}});
[[nodiscard]] constexpr std::string_view name_of(StepKind kind) noexcept {
  return step_names[kind];
}

/// The action after a step that has failed and has no retries left.
enum class OnFail : std::uint8_t {
  vent,      ///< the sequence ends, and its channels go to the rest pressure
  hold,      ///< the sequence ends, and the commands do not change
  abort,     ///< the sequence ends with the safe_action of the rig file for the present phase
  release,   ///< the sequence continues with the next release step; without such a step, the action is vent
  carry_on,  ///< `continue` in the file: the sequence continues with its next step
};
/// Names of the actions in sequence files.
inline constexpr auto on_fail_names = enum_names<OnFail>({{OnFail::vent, "vent"},
                                                          {OnFail::hold, "hold"},
                                                          {OnFail::abort, "abort"},
                                                          {OnFail::release, "release"},
                                                          {OnFail::carry_on, "continue"}});
[[nodiscard]] constexpr std::string_view name_of(OnFail action) noexcept {
  return on_fail_names[action];
}

/// The action when a finger meets an object during the motion of its step.
enum class OnContact : std::uint8_t {
  hold,     ///< the finger stays at the pressure of the first contact, and its step is finished
  grip,     ///< the finger stays at the pressure of the first contact, and the sequence continues with its
            ///< next grip step at once
  fail,     ///< the finger stays at the pressure of the first contact, and its step fails
  ignore,   ///< the motion continues as if there were no contact
  squeeze,  ///< for a grip with squeeze_kpa: the gripping pressure increases to squeeze_kpa (not a value in
            ///< files)
  close,    ///< for a grip without squeeze_kpa: the motion continues to its target while the feedback stays
            ///< constant (not a value in files)
};
/// Names of the actions on contact, in sequence files and events.
inline constexpr auto on_contact_names = enum_names<OnContact>({{OnContact::hold, "hold"},
                                                                {OnContact::grip, "grip"},
                                                                {OnContact::fail, "fail"},
                                                                {OnContact::ignore, "ignore"},
                                                                {OnContact::squeeze, "squeeze"},
                                                                {OnContact::close, "close"}});
[[nodiscard]] constexpr std::string_view name_of(OnContact action) noexcept {
  return on_contact_names[action];
}

/// The criterion by which a grip is verified.
enum class VerifyBy : std::uint8_t {
  detection,  ///< the finger moved less than its free-motion model
  position,   ///< the displacement is between a lower and an upper value
  pressure,   ///< weaker criterion: the measured pressure has reached a bound
};
inline constexpr auto verify_by_names = enum_names<VerifyBy>(
    {{VerifyBy::detection, "detection"}, {VerifyBy::position, "position"}, {VerifyBy::pressure, "pressure"}});
[[nodiscard]] constexpr std::string_view name_of(VerifyBy by) noexcept {
  return verify_by_names[by];
}

/// Target of a ramp. Either the duration `duration_s` or the speed `speed` [unit of the target per s]
/// determines the time of the ramp.
struct Target {
  enum class Quantity : std::uint8_t { displacement_mm, pressure_kpa };
  Quantity quantity = Quantity::pressure_kpa;
  double value = 0;
  bool at_rest = false;   ///< true: the target is the rest pressure of the channel; `value` is not used
  double speed = 0;       ///< speed of the ramp; 0: the ramp has the duration duration_s
  double duration_s = 0;  ///< duration of the ramp; if duration_s and speed are both 0, the ramp is as fast
                          ///< as the limits allow
};

struct Verify {
  VerifyBy by = VerifyBy::detection;
  double window_s = 0.3;  ///< time for which the evidence of the grip must be present without interruption
  double displacement_min_mm = -std::numeric_limits<double>::infinity();  ///< lower bound of the
                                                                          ///< displacement: the criterion of
                                                                          ///< verification by position, an
                                                                          ///< additional condition of
                                                                          ///< verification by detection
  double displacement_max_mm = std::numeric_limits<double>::infinity();   ///< upper bound of the
                                                                          ///< displacement: the criterion of
                                                                          ///< verification by position, an
                                                                          ///< additional condition of
                                                                          ///< verification by detection
  double pressure_min_kpa = 0;  ///< lower bound for verification by pressure, if the grip is above the rest
                                ///< pressure
  double pressure_max_kpa = std::numeric_limits<double>::infinity();  ///< upper bound for verification by
                                                                      ///< pressure, if the grip is below the
                                                                      ///< rest pressure
  /// Returns true if the grip is verified by a pressure below the rest pressure.
  [[nodiscard]] bool below() const noexcept { return std::isfinite(pressure_max_kpa); }
};

/// A point of a piecewise linear profile.
struct Point {
  double time_s = 0;
  double pressure_kpa = 0;
  bool operator==(const Point&) const = default;
};

/// Pressure over time of a pressure step: points or a test signal, repeated `cycles` times.
struct Profile {
  std::vector<Point> points;  ///< points of the profile; their times start at 0 and do not decrease, and two
                              ///< points at the same time form a jump
  std::optional<model::SignalName> signal;  ///< test signal, used in place of points
  double scale = 1;                         ///< factor by which the values of the signal are multiplied
  std::uint32_t cycles = 1;
};
/// Returns the duration of one cycle [s].
[[nodiscard]] double cycle_s(const Profile& profile) noexcept;
/// Returns the duration of all cycles [s].
[[nodiscard]] double duration_s(const Profile& profile) noexcept;
/// Returns the pressure of the profile at the time `time_s` after its start [kPa]. Before the start, this is
/// the first value; after the end, the last value; at a jump, the value after the jump. Does not allocate
/// memory.
[[nodiscard]] double value_at(const Profile& profile, double time_s) noexcept;

/// Displacement reference of a track step: mean_mm - amplitude_mm cos(2 pi frequency_hz t). The reference
/// starts at its lowest value.
struct Sine {
  double mean_mm = 0;
  double amplitude_mm = 0;
  double frequency_hz = 0;
  std::uint32_t cycles = 1;
};

/// Upper bounds of the command in a step.
struct Bounds {
  double pressure_max_kpa = std::numeric_limits<double>::infinity();
  /// Upper bound of the gripping pressure [kPa]. The gripping pressure is the command minus the command under
  /// which the free finger rests at the present displacement.
  double squeeze_max_kpa = std::numeric_limits<double>::infinity();
};

/// Gripping pressure that a grip step applies after its first contact.
struct Squeeze {
  double by_kpa = 0;           ///< pressure above the pressure of the free finger at the same displacement;
                               ///< 0: the target of the grip alone determines the pressure
  double speed_kpa_per_s = 0;  ///< rate at which the gripping pressure increases; above 0 if by_kpa is above
                               ///< 0
};

/// One step of a sequence, as written in the file.
struct Step {
  StepKind kind = StepKind::move;
  std::string name;  ///< name of the step for messages; the default is the name of its kind
  document::Location at;
  std::vector<std::string> channels;   ///< channels that take part in the step; empty: all channels of the
                                       ///< sequence
  Target target;                       ///< target of the steps move, grip and release
  Sine sine;                           ///< reference of a track step
  Profile profile;                     ///< pressure over time of a pressure step
  double settle_s = 0;                 ///< waiting time after the end of the ramp
  std::optional<double> tolerance_mm;  ///< for move: the step fails if the displacement does not stay within
                                       ///< this tolerance of the target for settle_s before timeout_s ends
  Bounds bounds;                       ///< upper bounds of the command, for all kinds of steps except
                                       ///< release; a hold has bounds of its own only if the file gives them
  OnContact on_contact = OnContact::ignore;
  bool on_contact_stated = false;  ///< true: the sequence file gives the key on_contact
  Squeeze squeeze;                 ///< gripping pressure of a grip step
  Verify verify;                   ///< criterion by which a grip step is verified
  double hold_s = 0;               ///< duration of a hold step; infinite: the hold lasts until a release is
                                   ///< requested
  double reverify_every_s = 0;     ///< for hold: time between two verifications
  double purge_s = 0;              ///< for release: time for which the channels stay at the rest pressure
  std::optional<double> timeout_s;
  std::uint32_t retries = 0;
  OnFail on_fail = OnFail::abort;
};

/// The situations in which an open interlock input has an effect.
enum class Interlock : std::uint8_t {
  start,   ///< while the interlock is open, a start is refused
  always,  ///< while the interlock is open, a start is refused; when it opens, a running sequence is stopped
};

inline constexpr auto interlock_names =
    enum_names<Interlock>({{Interlock::start, "start"}, {Interlock::always, "always"}});

/// A sequence as written in the file.
struct Sequence {
  std::string name;
  std::string about;  ///< description of the sequence in one line; may be empty
  Interlock interlock = Interlock::start;
  std::vector<std::string> channels;  ///< channels that the sequence uses; empty: all channels of the rig
  std::vector<Parameter> parameters;  ///< the parameters of the sequence, with the values that are inserted
                                      ///< into the steps
  std::vector<Step> steps;
  std::string file;  ///< name of the file as the user wrote it
  std::string text;  ///< text of the file, for messages and for the provenance of a recording
};

/// A step after it was fitted to the channels and limits of a rig.
struct PreparedStep {
  Step step;
  std::uint32_t channels = 0;      ///< bit i: channel i takes part in the step
  std::uint16_t release_step = 0;  ///< index of the next release step, for `on_fail: release`; the number of
                                   ///< steps if there is none
  std::uint16_t grip_step = 0;     ///< index of the next grip step, for `on_contact: grip`; the number of
                                   ///< steps if there is none
  /// Plans for the feedforward `planned`, by channel of the rig; empty if there are no plans.
  std::vector<PressurePlan> plans;
  /// Returns the plan of a channel; nullptr if the channel has no plan.
  [[nodiscard]] const PressurePlan* plan_of(std::size_t channel) const noexcept {
    return channel < plans.size() && !plans[channel].empty() ? &plans[channel] : nullptr;
  }
};

/// A sequence after it was fitted to one rig: channel names are replaced by indices, and targets are checked
/// against the limits. A prepared sequence does not change while it runs.
struct PreparedSequence {
  std::string name;
  Interlock interlock = Interlock::start;
  std::uint32_t channels = 0;         ///< channels of all steps; bit i is channel i
  std::uint32_t needs_detection = 0;  ///< bit mask of the channels that are verified by detection; at rest,
                                      ///< the free-motion model of these channels must agree with the reading
  std::uint64_t rig = 0;              ///< rig_key() of the settings for which the sequence was prepared
  std::vector<Argument> parameters;   ///< values of the sequence's parameters, for status and events
  std::vector<PreparedStep> steps;
  double planned_s = 0;  ///< duration of the planned motion of the channel with the longest planned motion
};

/// Returns a hash of the rig settings on which a prepared sequence depends.
[[nodiscard]] std::uint64_t rig_key(const RigSettings& settings) noexcept;

}  // namespace softgrip::control
