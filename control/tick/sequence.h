#pragma once
// Grip sequences as plain values: as written (Sequence), and fitted to one rig (PreparedSequence).
// The keys of the file carry the same names; docs/reference/sequence-file.md describes them.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "control/feedforward/pressure_plan.h"
#include "control/tick/parameter.h"
#include "control/tick/settings.h"
#include "document/problem.h"
#include "model/signals.h"

namespace softgrip::control {

/// An unlimited time or an unbounded pressure.
inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// Returns the bit of a channel in a mask.
constexpr std::uint32_t channel_bit(std::size_t channel) noexcept {
  return 1U << channel;
}

/// The kind of a step; its name is the key of the step in the file.
enum class StepKind : std::uint8_t {
  move,      ///< to a target, with a ramp
  grip,      ///< to a target, then verification: HOLDING or NO PART
  hold,      ///< stays and re-verifies: PART LOST when the object is gone
  release,   ///< to rest, purge: RELEASED
  track,     ///< a displacement over time, with feedback (studies)
  pressure,  ///< a pressure over time, without feedback (experiments)
};
[[nodiscard]] std::string_view name_of(StepKind kind) noexcept;

/// The action if a step fails and no retries are left.
enum class OnFail : std::uint8_t {
  vent,      ///< the sequence ends, to the rest pressure
  hold,      ///< the sequence ends, the command stays
  abort,     ///< the sequence ends as the rig file's safe_action says for the phase
  release,   ///< on with the next release step; as vent where there is none
  carry_on,  ///< `continue`: on with the next step
};
/// As in the file: "vent", "hold", "abort", "release", "continue".
[[nodiscard]] std::string_view name_of(OnFail action) noexcept;

/// The action if a finger meets an object during its motion.
enum class OnContact : std::uint8_t {
  hold,     ///< stays at the pressure of the first contact; its step is done
  grip,     ///< as hold, and the sequence continues with its next grip step at once
  fail,     ///< stays so, and its step fails
  ignore,   ///< goes on as if nothing were there
  squeeze,  ///< of a grip with squeeze_kpa: adds this gripping pressure (not written in files)
  close,    ///< of any other grip: goes on to its target with its feedback held (not written in files)
};
/// "hold", "grip", "fail", "ignore", "squeeze", "close"
[[nodiscard]] std::string_view name_of(OnContact action) noexcept;

/// On what a grip is verified.
enum class VerifyBy : std::uint8_t {
  detection,  ///< the finger moved less than its free-motion envelope
  position,   ///< the displacement is within a window
  pressure,   ///< weaker: the measured pressure is there
};
[[nodiscard]] std::string_view name_of(VerifyBy by) noexcept;

/// Where a ramp goes. A ramp takes `duration_s`, or moves with `speed` [target's unit per s].
struct Target {
  enum class Quantity : std::uint8_t { displacement_mm, pressure_kpa };
  Quantity quantity = Quantity::pressure_kpa;
  double value = 0;
  bool at_rest = false;   ///< the rest pressure of the channel instead of value
  double speed = 0;       ///< 0: duration_s counts
  double duration_s = 0;  ///< 0 with speed 0: as fast as the limits allow
};

struct Verify {
  VerifyBy by = VerifyBy::detection;
  double window_s = 0.3;  ///< the evidence must hold for all of it
  double displacement_min_mm = -std::numeric_limits<double>::infinity();  ///< of position; with detection,
  double displacement_max_mm = std::numeric_limits<double>::infinity();   ///< both must agree
  double pressure_min_kpa = 0;                                        ///< of pressure, for grips above rest
  double pressure_max_kpa = std::numeric_limits<double>::infinity();  ///< of pressure, for grips below rest
  /// By a pressure that is below rest.
  [[nodiscard]] bool below() const noexcept { return std::isfinite(pressure_max_kpa); }
};

/// A point of a piecewise linear profile.
struct Point {
  double time_s = 0;
  double pressure_kpa = 0;
  bool operator==(const Point&) const = default;
};

/// Pressure over time of a pressure step: points or a test signal, `cycles` times.
struct Profile {
  std::vector<Point> points;  ///< times from 0, not decreasing; a jump is two points at one time
  std::optional<model::SignalName> signal;  ///< instead of points
  double scale = 1;                         ///< of the signal
  std::uint32_t cycles = 1;
};
/// Returns the duration of one cycle [s].
[[nodiscard]] double cycle_s(const Profile& profile) noexcept;
/// Returns the duration of all cycles [s].
[[nodiscard]] double duration_s(const Profile& profile) noexcept;
/// The profile at `time_s` since its start; its first value before, its last after; at a jump the value
/// after it. Allocates nothing.
[[nodiscard]] double value_at(const Profile& profile, double time_s) noexcept;

/// Displacement over time of a track step: mean - amplitude cos(2 pi f t), which starts at its lowest.
struct Sine {
  double mean_mm = 0;
  double amplitude_mm = 0;
  double frequency_hz = 0;
  std::uint32_t cycles = 1;
};

/// Upper bounds of the command in a step.
struct Bounds {
  double pressure_max_kpa = std::numeric_limits<double>::infinity();
  /// Relative to the command that the free finger needs to rest at the present displacement.
  double squeeze_max_kpa = std::numeric_limits<double>::infinity();
};

/// How a grip presses from its first touch on.
struct Squeeze {
  double by_kpa = 0;           ///< above what the free finger needs to rest there; 0: the target alone counts
  double speed_kpa_per_s = 0;  ///< > 0 with by_kpa
};

/// One step as written.
struct Step {
  StepKind kind = StepKind::move;
  std::string name;  ///< for people; the kind where none is given
  document::Location at;
  std::vector<std::string> channels;   ///< empty: those of the sequence
  Target target;                       ///< of move, grip, release
  Sine sine;                           ///< of track
  Profile profile;                     ///< of pressure
  double settle_s = 0;                 ///< waited after the ramp
  std::optional<double> tolerance_mm;  ///< of move: within it for settle_s, or the step fails at timeout_s
  Bounds bounds;                       ///< of all but release; of hold where it has its own
  OnContact on_contact = OnContact::ignore;
  bool on_contact_stated = false;  ///< the file says it
  Squeeze squeeze;                 ///< of grip
  Verify verify;                   ///< of grip
  double hold_s = 0;               ///< infinite: until a release is requested
  double reverify_every_s = 0;     ///< of hold
  double purge_s = 0;              ///< of release: stays at the rest pressure
  std::optional<double> timeout_s;
  std::uint32_t retries = 0;
  OnFail on_fail = OnFail::abort;
};

/// When an open interlock matters.
enum class Interlock : std::uint8_t {
  start,   ///< a start is refused
  always,  ///< and a running sequence is stopped
};

/// A recipe as written.
struct Sequence {
  std::string name;
  std::string about;  ///< one line, may be empty
  Interlock interlock = Interlock::start;
  std::vector<std::string> channels;  ///< empty: all of the rig
  std::vector<Parameter> parameters;  ///< with the values used in the steps
  std::vector<Step> steps;
  std::string file;  ///< as the user named it
  std::string text;  ///< the file's text, for messages and for the recording's provenance
};

/// A step fitted to a rig.
struct PreparedStep {
  Step step;
  std::uint32_t channels = 0;      ///< bit i: channel i takes part
  std::uint16_t release_step = 0;  ///< where on_fail: release goes; the number of steps: nowhere
  std::uint16_t grip_step = 0;     ///< where on_contact: grip goes; the number of steps: nowhere
  /// By channel of the rig, for feedforward `planned`; empty where nothing is planned.
  std::vector<PressurePlan> plans;
  /// nullptr if there is none.
  [[nodiscard]] const PressurePlan* plan_of(std::size_t channel) const noexcept {
    return channel < plans.size() && !plans[channel].empty() ? &plans[channel] : nullptr;
  }
};

/// A sequence fitted to one rig: names resolved, targets checked against the limits. Immutable while it runs.
struct PreparedSequence {
  std::string name;
  Interlock interlock = Interlock::start;
  std::uint32_t channels = 0;  ///< all that take part in any step
  std::uint32_t needs_detection =
      0;                  ///< those that are verified by detection: their free model must agree at rest
  std::uint64_t rig = 0;  ///< rig_key() of the settings it was prepared for
  std::vector<Argument> parameters;  ///< values of its parameters, for status and events
  std::vector<PreparedStep> steps;
  double planned_s = 0;  ///< how much motion the plans are for; the channel with the most of it
};

/// Distinguishes rigs as far as a prepared sequence depends on them.
[[nodiscard]] std::uint64_t rig_key(const RigSettings& settings) noexcept;

}  // namespace softgrip::control
