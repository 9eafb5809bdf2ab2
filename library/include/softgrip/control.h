#pragma once
/// @file
/// Control of one finger: limits, PID, feedforward, and a controller that combines them. The changelog
/// announces every incompatible change.
///
/// Constructors check their arguments and allocate memory. All other functions do not allocate, lock or
/// throw, so a control loop can call them. Only one thread at a time may use an object.

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
  double pressure_max_kpa = 0;       ///< largest command [kPa]; it must be above pressure_min_kpa
  double slew_up_kpa_per_s = 300;    ///< fastest rise of the command [kPa/s], > 0
  double slew_down_kpa_per_s = 300;  ///< fastest fall of the command [kPa/s], > 0
  double displacement_min = -1e6;    ///< lower limit of displacement references
  double displacement_max = 1e6;     ///< upper limit of displacement references; it must be above
                                     ///< displacement_min
  double rest_kpa = 0;               ///< command while the finger rests [kPa]; it is limited to the range of
                                     ///< the command
};

/// A command that is within the limits.
struct LimitedCommand {
  double command_kpa = 0;  ///< the command, within the pressure range and the slew limits [kPa]
  bool saturated = false;  ///< true: the request is outside the pressure range
  bool slewing = false;    ///< true: the request changes faster than the slew limits allow
  bool invalid = false;    ///< the request is not a number, so the command is the last command
};

/// Returns the command for a requested pressure. The daemon uses the same function.
/// @param limits      limits of the finger
/// @param wanted_kpa  the request [kPa]
/// @param last_kpa    last command [kPa]
/// @param elapsed_s   time since the last command [s], >= 0
[[nodiscard]] SOFTGRIP_API LimitedCommand limit(const Limits& limits, double wanted_kpa, double last_kpa,
                                                double elapsed_s) noexcept;

/// Method against integrator windup, which occurs while the command cannot follow the request.
enum class AntiWindup : std::uint8_t {
  none,              ///< no anti-windup (for comparisons)
  conditional,       ///< the integrator stops while it would move a limited request further beyond the limit
  back_calculation,  ///< the part of the request that the limits remove drives the integrator back within
                     ///< `tracking_time_s`
};

/// Settings of a PID controller. Displacements are in the unit of the model.
struct PidSettings {
  double kp_kpa_per_mm = 0;           ///< proportional gain [kPa per unit of the model]
  double ki_kpa_per_mm_s = 0;         ///< integral gain [kPa per unit of the model and s]
  double kd_kpa_s_per_mm = 0;         ///< derivative gain [kPa s per unit of the model]
  double derivative_filter_s = 0.02;  ///< time constant of the filter of the derivative [s], >= 0
  double setpoint_weight = 1;         ///< share of the reference in the proportional part, 0 to 1
  AntiWindup anti_windup = AntiWindup::back_calculation;  ///< method against integrator windup
  double tracking_time_s = 0.5;                           ///< time constant for back_calculation [s], > 0
};

/// PID controller with two degrees of freedom (Astrom and Hagglund, Advanced PID Control, 2006). In each
/// period, call step(), then limit() for the sum of feedforward and feedback, then sent() with the limited
/// command.
class SOFTGRIP_API Pid {
 public:
  /// Creates a PID controller. Throws InvalidArgument.
  /// @param settings  gains and filters
  /// @param tick_s    period of step() [s], > 0
  Pid(const PidSettings& settings, double tick_s);
  ~Pid();
  /// Moves the state of `other` into this object. After that, `other` can only be assigned to or destroyed.
  Pid(Pid&& other) noexcept;
  /// Moves the state of `other` into this object. After that, `other` can only be assigned to or destroyed.
  Pid& operator=(Pid&& other) noexcept;

  /// Sets the integrator so that the next step() continues from the command `command_kpa` [kPa]. Call this
  /// function at a start and after a change of the feedforward.
  void align(double command_kpa) noexcept;
  /// Returns the feedback of this period [kPa]. The request is the sum of the feedback and `feedforward_kpa`.
  /// @param reference        reference at the time of the measurement
  /// @param measurement      the reading
  /// @param feedforward_kpa  feedforward of this period [kPa]
  [[nodiscard]] double step(double reference, double measurement, double feedforward_kpa) noexcept;
  /// Returns the feedback for a period without a usable measurement [kPa]. Integrator and derivative do not
  /// change.
  [[nodiscard]] double hold(double feedforward_kpa) noexcept;
  /// Reports the command that was sent after the limits [kPa]. The anti-windup uses this command.
  void sent(double command_kpa) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A reference that is known in advance. It has up to 8 segments, and its value at any time can be computed.
/// In ramps and holds, value, rate and acceleration are continuous (minimum jerk).
class SOFTGRIP_API Reference {
 public:
  /// Creates a reference that has the value `value` from time 0 s on.
  explicit Reference(double value = 0);
  ~Reference();
  /// Creates a reference with a copy of all segments of `other`.
  Reference(const Reference& other);
  /// Replaces the segments by a copy of the segments of `other`.
  Reference& operator=(const Reference& other);

  /// Removes all segments. From the time `time_s` [s] on, the reference has the value `value`.
  void start(double time_s, double value) noexcept;
  /// Appends a minimum-jerk ramp to `value` with the duration `duration_s` [s], > 0. If there are already 8
  /// segments, or if an argument is out of range, changes nothing and returns false.
  bool ramp_to(double value, double duration_s) noexcept;
  /// Appends a constant segment of the duration `duration_s` [s], > 0. Returns false under the same
  /// conditions as ramp_to().
  bool hold_for(double duration_s) noexcept;
  /// Appends `cycles` cycles (> 0) of mean - amplitude cos(2 pi f t), with the frequency f = `frequency_hz` >
  /// 0. Before the sine, the reference should be at mean - amplitude. Returns false under the same conditions
  /// as ramp_to().
  bool sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept;
  /// Returns the value of the reference at a time [s].
  [[nodiscard]] double at(double time_s) const noexcept;
  /// Returns the time at which the last segment ends [s].
  [[nodiscard]] double end_s() const noexcept;

  /// Content of the object; its definition is not public.
  struct Parts;
  /// Returns the content of the object, for the library itself.
  [[nodiscard]] const Parts& parts() const noexcept { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

/// The kind of a feedforward.
enum class FeedforwardKind : std::uint8_t {
  none,        ///< the command has no feedforward part
  bouc_wen,    ///< inverse of the hysteresis without the rest of the model
  full_model,  ///< inverse of the whole model: hysteresis, creep, lag, dead time
};

/// Result of Feedforward::step().
struct FeedforwardStep {
  double pressure_kpa = 0;    ///< pressure command of this period [kPa]
  bool out_of_reach = false;  ///< true: because of the limits, the command cannot reach the reference
};

/// Computes the command for a reference with the inverse of a model, one command per period. Each call gets
/// one sample of the reference, so the reference need not be an object of the class Reference.
class SOFTGRIP_API Feedforward {
 public:
  /// Computes the inverse of a model. Throws InvalidArgument, and Refused if the model has no inverse within
  /// the limits.
  /// @param model            model of the finger
  /// @param limits           limits of the command
  /// @param tick_s           period of step() [s], > 0
  /// @param kind             kind of feedforward
  /// @param extra_latency_s  latency from a command to the output of the board [s], 0 to 1. The latency is
  ///                         added to the dead time of the model.
  Feedforward(const Model& model, const Limits& limits, double tick_s,
              FeedforwardKind kind = FeedforwardKind::full_model, double extra_latency_s = 0);
  ~Feedforward();
  /// Moves the state of `other` into this object. After that, `other` can only be assigned to or destroyed.
  Feedforward(Feedforward&& other) noexcept;
  /// Moves the state of `other` into this object. After that, `other` can only be assigned to or destroyed.
  Feedforward& operator=(Feedforward&& other) noexcept;

  /// Returns the preview time [s]. step() needs the value that the reference will have after this time.
  [[nodiscard]] double preview_s() const noexcept;
  /// Starts with a finger at rest.
  /// @param command_kpa      command under which the finger is at rest [kPa]
  /// @param reference_ahead  value of the reference preview_s() after the present, in the unit of the model
  void start(double command_kpa, double reference_ahead) noexcept;
  /// Returns the command for this period. The board holds it until the next period.
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
  double reference = 0;                    ///< present value of the reference; NaN while no reference is
                                           ///< followed
  double displacement = 0;                 ///< last valid displacement reading
  double feedforward_kpa = 0;              ///< feedforward part of the command [kPa]
  double feedback_kpa = 0;                 ///< feedback part of the command [kPa]
  double residual = 0;                     ///< reading minus the reading that the model predicts
  Validity validity = Validity::none_yet;  ///< validity of the reading after the plausibility check
  bool saturated = false;                  ///< true: the request was outside the pressure range
  bool slewing = false;                    ///< true: the slew limits changed the requested pressure
  bool out_of_reach = false;               ///< true: the feedforward cannot reach the reference
};

/// Controller of one finger. It adds feedforward and PID feedback, limits their sum, and checks the
/// plausibility of the readings. The daemon uses the same controller for each channel; it adds sequences,
/// faults and a supervisor.
class SOFTGRIP_API Controller {
 public:
  /// Creates a controller. Throws InvalidArgument, and Refused if the model has no inverse for the
  /// feedforward.
  explicit Controller(const ControllerSettings& settings);
  ~Controller();
  /// Moves the state of `other` into this object. After that, `other` can only be assigned to or destroyed.
  Controller(Controller&& other) noexcept;
  /// Moves the state of `other` into this object. After that, `other` can only be assigned to or destroyed.
  Controller& operator=(Controller&& other) noexcept;

  /// Starts with a finger that rests under `command_kpa` [kPa]. This pressure is limited to the pressure
  /// range.
  void start(double command_kpa) noexcept;
  /// Follows a reference from the next tick() on. The times of the reference are on the same clock as `now`
  /// in tick().
  void follow(const Reference& reference) noexcept;
  /// Holds the present command from the next tick() on.
  void hold() noexcept;
  /// Goes to the rest pressure from the next tick() on, within the slew limits.
  void vent() noexcept;
  /// Goes to a pressure [kPa] from the next tick() on, within the slew limits and without feedback.
  void pressure(double pressure_kpa) noexcept;

  /// Executes one period and returns the command.
  /// @param now      time of this period on the clock of the readings
  /// @param reading  newest reading of the finger
  [[nodiscard]] ControlOutput tick(std::chrono::nanoseconds now, const Reading& reading) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip
