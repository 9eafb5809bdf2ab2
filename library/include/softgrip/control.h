#pragma once
/// @file
/// Declares the control of one finger: limits, PID, feedforward, and a controller that combines these three.
/// The changelog announces every incompatible change of this interface.
///
/// Constructors check their arguments and allocate memory. All other functions do not allocate memory, lock
/// or throw, so a control loop can call these functions. Only one thread at a time may use an object.

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <softgrip/board.h>
#include <softgrip/export.h>
#include <softgrip/model.h>

namespace softgrip {

/// Limits of one finger. Displacements are in the unit of the model.
struct Limits {
  double pressure_min_kpa = 0;       ///< smallest permitted command [kPa]
  double pressure_max_kpa = 0;       ///< largest permitted command [kPa]; it must be above pressure_min_kpa
  double slew_up_kpa_per_s = 300;    ///< largest rate of increase of the command [kPa/s], > 0
  double slew_down_kpa_per_s = 300;  ///< largest rate of decrease of the command [kPa/s], > 0
  double displacement_min = -1e6;    ///< lower limit of displacement references
  double displacement_max = 1e6;     ///< upper limit of displacement references; it must be above
                                     ///< displacement_min
  double rest_kpa = 0;               ///< command while the finger rests [kPa]; it is limited to the pressure
                                     ///< range
};

/// A command that is within the limits.
struct LimitedCommand {
  double command_kpa = 0;  ///< the command, within the pressure range and the slew limits [kPa]
  bool saturated = false;  ///< true: the requested pressure is outside the pressure range
  bool slewing = false;    ///< true: the requested pressure is further from the last command than the slew
                           ///< limits allow
  bool invalid = false;    ///< true: the requested pressure or the elapsed time is not a number, or the
                           ///< elapsed time is negative, so the result is the last command, limited to the
                           ///< pressure range
};

/// Returns the command for a requested pressure. The daemon uses this function too.
/// @param limits      limits of the finger
/// @param wanted_kpa  requested pressure [kPa]
/// @param last_kpa    last command [kPa]
/// @param elapsed_s   time since the last command [s], >= 0; otherwise the result is `invalid`
[[nodiscard]] SOFTGRIP_API LimitedCommand limit(const Limits& limits, double wanted_kpa, double last_kpa,
                                                double elapsed_s) noexcept;

/// Method that prevents integrator windup. Windup occurs while the limits keep the command away from the
/// request.
enum class AntiWindup : std::uint8_t {
  none,              ///< no anti-windup (for comparisons with the other methods)
  conditional,       ///< the integrator stops while it would move the requested pressure further beyond a
                     ///< limit
  back_calculation,  ///< the difference between requested pressure and limited command drives the integrator
                     ///< back within `tracking_time_s`
};

/// Settings of a PID controller. Displacements are in the unit of the model.
struct PidSettings {
  double kp_kpa_per_mm = 0;           ///< proportional gain [kPa per unit of the model]
  double ki_kpa_per_mm_s = 0;         ///< integral gain [kPa per unit of the model and s]
  double kd_kpa_s_per_mm = 0;         ///< derivative gain [kPa s per unit of the model]
  double derivative_filter_s = 0.02;  ///< time constant of the filter of the derivative [s], >= 0
  double setpoint_weight = 1;         ///< factor of the reference in the proportional part, 0 to 1
  AntiWindup anti_windup = AntiWindup::back_calculation;  ///< method against integrator windup
  double tracking_time_s = 0.5;                           ///< time constant with which back_calculation
                                                          ///< drives the integrator back [s], > 0
};

/// PID controller with two degrees of freedom (Astrom and Hagglund, Advanced PID Control, 2006). In each
/// period, call step(). Then pass the sum of feedforward and feedback to limit(), and the limited command to
/// sent().
class SOFTGRIP_API Pid {
 public:
  /// Creates a PID controller. Throws InvalidArgument if an argument is invalid.
  /// @param settings  gains and filters
  /// @param tick_s    period of step() [s], > 0
  Pid(const PidSettings& settings, double tick_s);
  ~Pid();
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Pid(Pid&& other) noexcept;
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Pid& operator=(Pid&& other) noexcept;

  /// Sets the integrator such that the next step() continues from the command `command_kpa` [kPa]. Call this
  /// function when control starts and after a change of the feedforward. A command that is not finite is
  /// ignored.
  void align(double command_kpa) noexcept;
  /// Returns the feedback of this period [kPa]. The requested pressure is the sum of this feedback and
  /// `feedforward_kpa`. If an argument is not finite, the function does the same as hold().
  /// @param reference        reference at the time of the measurement
  /// @param measurement      reading of the displacement
  /// @param feedforward_kpa  feedforward of this period [kPa]
  [[nodiscard]] double step(double reference, double measurement, double feedforward_kpa) noexcept;
  /// Returns the feedback for a period without a usable measurement [kPa], which is finite for any argument.
  /// The integrator and the derivative do not change.
  [[nodiscard]] double hold(double feedforward_kpa) noexcept;
  /// Receives the limited command that was sent to the board [kPa]. The anti-windup uses this command. A
  /// command that is not finite is ignored.
  void sent(double command_kpa) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A reference that is known in advance. It consists of up to 8 segments, from which its value at any time
/// can be computed. In ramps and holds, value, rate and acceleration are continuous (minimum jerk).
class SOFTGRIP_API Reference {
 public:
  /// Creates a reference that has the value `value` from time 0 s on.
  explicit Reference(double value = 0);
  ~Reference();
  /// Creates a reference with a copy of all segments of `other`.
  Reference(const Reference& other);
  /// Replaces the segments by a copy of the segments of `other`.
  Reference& operator=(const Reference& other);

  /// Removes all segments. From the time `time_s` [s] on, the reference is constant at `value`.
  void start(double time_s, double value) noexcept;
  /// Appends a minimum-jerk ramp to `value` with the duration `duration_s` [s], > 0. If the reference already
  /// has 8 segments, if an argument is out of range, or if the ramp or its end time would not be finite, the
  /// function has no effect and returns false.
  bool ramp_to(double value, double duration_s) noexcept;
  /// Appends a constant segment of the duration `duration_s` [s], > 0. Returns false under the conditions
  /// that ramp_to() states.
  bool hold_for(double duration_s) noexcept;
  /// Appends `cycles` cycles (> 0) of mean - amplitude cos(2 pi f t), with the frequency f = `frequency_hz` >
  /// 0. Before the sine, the reference should be at mean - amplitude. Returns false under the conditions that
  /// ramp_to() states.
  bool sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept;
  /// Returns the value of the reference at the time `time_s` [s].
  [[nodiscard]] double at(double time_s) const noexcept;
  /// Returns the time at which the last segment ends [s].
  [[nodiscard]] double end_s() const noexcept;

  /// Internal data of the object; the definition is not public.
  struct Parts;
  /// Returns the internal data of the object. Only the library calls this function.
  [[nodiscard]] const Parts& parts() const noexcept { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

/// The kind of a feedforward.
enum class FeedforwardKind : std::uint8_t {
  none,        ///< the command has no feedforward part
  bouc_wen,    ///< inverse of the hysteresis element without the rest of the model
  full_model,  ///< inverse of the whole model: hysteresis, creep, lag and dead time
};

/// Result of Feedforward::step().
struct FeedforwardStep {
  double pressure_kpa = 0;    ///< pressure command of this period [kPa]
  bool out_of_reach = false;  ///< true: because of the limits, the finger cannot reach the reference, or the
                              ///< reference is not finite
};

/// Computes the command for a reference with the inverse of a model, one command per period. Each call of
/// step() gets one sample of the reference. Therefore, the reference need not be an object of the class
/// Reference.
class SOFTGRIP_API Feedforward {
 public:
  /// Computes the inverse of a model. Throws InvalidArgument if an argument is invalid. Throws Refused if
  /// the model has no inverse within the limits, or if its settled displacement does not rise with the
  /// command.
  /// @param model            model of the finger
  /// @param limits           limits of the command
  /// @param tick_s           period of step() [s], 0.0001 to 1
  /// @param kind             kind of feedforward
  /// @param extra_latency_s  latency from a command to the output of the board [s], 0 to 1. The latency is
  ///                         added to the dead time of the model.
  Feedforward(const Model& model, const Limits& limits, double tick_s,
              FeedforwardKind kind = FeedforwardKind::full_model, double extra_latency_s = 0);
  ~Feedforward();
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Feedforward(Feedforward&& other) noexcept;
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Feedforward& operator=(Feedforward&& other) noexcept;

  /// Returns the preview time [s]. step() needs the value of the reference at the time "now + preview_s()".
  [[nodiscard]] double preview_s() const noexcept;
  /// Starts the feedforward with a finger at rest. If an argument is not finite, the call has no effect.
  /// @param command_kpa      command under which the finger is at rest [kPa]
  /// @param reference_ahead  value of the reference preview_s() after the present, in the unit of the model
  void start(double command_kpa, double reference_ahead) noexcept;
  /// Returns the command for this period. The board holds this command until the next period. If
  /// `reference_ahead` is not finite, the result is the last command with `out_of_reach` = true, and the
  /// model advances by one period under this command, as the finger does. The last command is then the
  /// command of start(), limited to the pressure range, if no step followed start(). For the kind `none`, the
  /// command is always 0.
  /// @param reference_ahead  value of the reference preview_s() after the present, in the unit of the model
  [[nodiscard]] FeedforwardStep step(double reference_ahead) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Settings of a Controller.
struct ControllerSettings {
  Model model;                                                ///< model of the finger in free motion
  Limits limits = {};                                         ///< limits of command and reference
  PidSettings pid = {};                                       ///< settings of the PID controller
  FeedforwardKind feedforward = FeedforwardKind::full_model;  ///< kind of feedforward that the controller
                                                              ///< uses
  double extra_latency_s = 0;       ///< latency from a command to the output of the board [s], 0 to 1
  double tick_s = 0.005;            ///< period of tick() [s], 0.0001 to 1
  double sensor_noise = 0.05;       ///< standard deviation of a reading, in the unit of the model, > 0
  double reading_max_age_s = 0.05;  ///< longest age of a reading that is used [s], 0.0001 to 60
};

/// Result of Controller::tick(). A value that is not available is NaN.
struct ControlOutput {
  double command_kpa = 0;                  ///< command for the board [kPa], within the limits
  double reference = 0;                    ///< value of the reference at this time; NaN while no reference is
                                           ///< followed
  double displacement = 0;                 ///< last valid reading of the displacement
  double feedforward_kpa = 0;              ///< feedforward part of the requested pressure [kPa]
  double feedback_kpa = 0;                 ///< feedback part of the requested pressure [kPa]
  double residual = 0;                     ///< reading minus the reading that the model predicts for the time
                                           ///< of the reading
  Validity validity = Validity::none_yet;  ///< validity of the reading after the plausibility check
  bool saturated = false;                  ///< true: the requested pressure was outside the pressure range
  bool slewing = false;                    ///< true: the slew limits changed the requested pressure
  bool out_of_reach = false;               ///< true: the feedforward cannot reach the reference
};

/// Controller of one finger. The controller adds feedforward and PID feedback, limits the sum, and checks the
/// plausibility of the readings. The daemon uses this controller for each channel, together with sequences,
/// faults and a supervisor.
class SOFTGRIP_API Controller {
 public:
  /// Creates a controller. Throws InvalidArgument if a setting is invalid, and Refused if the model has no
  /// inverse for the feedforward, or if its settled displacement does not rise with the command.
  explicit Controller(const ControllerSettings& settings);
  ~Controller();
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Controller(Controller&& other) noexcept;
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Controller& operator=(Controller&& other) noexcept;

  /// Starts control of a finger that rests under the command `command_kpa` [kPa]. This command is limited to
  /// the pressure range.
  void start(double command_kpa) noexcept;
  /// Follows a reference from the next tick() on. The times of the reference are on the clock of the argument
  /// `now` of tick().
  void follow(const Reference& reference) noexcept;
  /// Holds the present command from the next tick() on.
  void hold() noexcept;
  /// Goes to the rest pressure from the next tick() on, within the slew limits.
  void vent() noexcept;
  /// Goes to a pressure [kPa] from the next tick() on, within the slew limits and without feedback.
  void pressure(double pressure_kpa) noexcept;

  /// Executes one period and returns the command.
  /// @param now      start time of this period, on the clock of Reading::sampled_at
  /// @param reading  newest reading of the finger
  [[nodiscard]] ControlOutput tick(std::chrono::nanoseconds now, const Reading& reading) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip
