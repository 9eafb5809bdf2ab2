#pragma once
// Simulates the control of a finger that follows a sine, for studies, tuning and tests.

#include <cstdint>
#include <vector>

#include "control/feedforward/pressure_plan.h"
#include "control/tick/settings.h"
#include "model/model.h"

namespace softgrip::control {

/// The motion of the finger in the measured cycles, one value per tick. Time 0 is the start of the measured
/// cycles.
struct TrackingTrace {
  std::vector<double> time_s;
  std::vector<double> reference_mm;
  std::vector<double> displacement_mm;
};

/// One simulation consists of a rest, a ramp to the lowest point of the sine, and cycles of the sine. The
/// board outputs each command for the duration of a tick, beginning `exchange_s` after the tick. The reading
/// is taken in the exchange that writes the command, and the controller uses this reading in the next tick.
struct TrackingRun {
  ChannelSettings settings;  ///< settings of the controller, including its model
  model::Model finger;       ///< the simulated finger
  double rate_hz = 200;
  double mean_mm = 13;
  double amplitude_mm = 7;
  double frequency_hz = 0.1;
  double settling_cycles = 1;  ///< number of cycles before the measured cycles
  double measured_cycles = 2;
  double exchange_s = 0;        ///< time from the start of a tick to its exchange; less than one period of
                                ///< the tick
  double noise_mm = 0.03;       ///< standard deviation of the sensor's white noise
  double reading_step_mm = 0;   ///< quantisation of the reading; 0: no quantisation
  double command_step_kpa = 0;  ///< quantisation of the board's output; 0: no quantisation
  std::uint64_t seed = 1;
  /// Result of plan_for(), for the feedforward `planned`. If the pointer is null, the plan is computed for
  /// this simulation.
  const PressurePlan* plan = nullptr;
  TrackingTrace* trace = nullptr;  ///< destination of the motion of the finger; nullptr: the motion is not
                                   ///< stored
};

/// Computes the plan for the reference of a simulation, with the model of the controller.
[[nodiscard]] PressurePlan plan_for(const TrackingRun& run);

/// Tracking result over the measured cycles. The errors are computed from the displacement of the finger
/// itself, without sensor noise.
struct TrackingResult {
  double rmse_mm = 0;
  double worst_mm = 0;
  double pressure_mean_kpa = 0;  ///< mean of the pressure commands
  double pressure_most_kpa = 0;
  double residual_rms_mm = 0;                 ///< root mean square of the residual, which is the reading
                                              ///< minus the output of the controller's running model
  double out_of_reach_share = 0;              ///< share of the ticks in which the reference was out of reach
  double cut_share = 0;                       ///< share of the ticks in which a limit changed the requested
                                              ///< command
  HealthState health = HealthState::unknown;  ///< worst state of the model's health
};
[[nodiscard]] TrackingResult track(const TrackingRun& run);

/// Returns the model with each parameter multiplied by a random factor of its own. The factors are uniformly
/// distributed in [1 - relative, 1 + relative]. Parameters that are whole numbers do not change.
[[nodiscard]] model::Model with_scatter(const model::Model& model, double relative, std::uint64_t seed);

/// Stability margins of the control loop that consists of PID and model. The model is linearised: its gain is
/// the slope of displacement over pressure.
struct LoopMargins {
  double sensitivity = 0;   ///< largest sensitivity Ms of the loop, max |1/(1+L)|; infinite for an unstable
                            ///< loop
  double crossover_hz = 0;  ///< lowest frequency at which the loop gain |L| is 1
};
/// Returns the worst margins over the smallest and the largest instantaneous gain of the model. The
/// instantaneous gain is evaluated over the pressure range, on both sides of 0 kPa. The loop includes the
/// model's dead time, half a tick for the hold of the output, and the age `age_s` of the reading.
[[nodiscard]] LoopMargins loop_margins(const model::Model& model, const PidSettings& pid,
                                       const LimitSettings& limits, double tick_s, double age_s);

}  // namespace softgrip::control
