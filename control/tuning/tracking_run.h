#pragma once
// Simulates a finger that tracks a sine, for studies, tuning and tests.

#include <cstdint>
#include <vector>

#include "control/feedforward/pressure_plan.h"
#include "control/tick/channel_settings.h"
#include "model/model.h"

namespace softgrip::control {

/// The finger's motion in the measured cycles, one value per tick. Times count from the start of these
/// cycles.
struct TrackingTrace {
  std::vector<double> time_s;
  std::vector<double> reference_mm;
  std::vector<double> displacement_mm;
};

/// One run consists of a rest, a ramp to the lowest point of the sine, and cycles of the sine. The board
/// outputs each command for the duration of a tick, beginning `exchange_s` after the tick. The reading is
/// taken in the same exchange, so a reading is a tick old when it is used.
struct TrackingRun {
  ChannelSettings settings;  ///< the controller with its model
  model::Model finger;       ///< the simulated finger
  double rate_hz = 200;
  double mean_mm = 13;
  double amplitude_mm = 7;
  double frequency_hz = 0.1;
  double settling_cycles = 1;  ///< cycles before the measured ones
  double measured_cycles = 2;
  double exchange_s = 0;        ///< time from the tick to the exchange; less than a period
  double noise_mm = 0.03;       ///< standard deviation of the sensor's white noise
  double reading_step_mm = 0;   ///< quantisation of the reading; 0: none
  double command_step_kpa = 0;  ///< quantisation of the output; 0: none
  std::uint64_t seed = 1;
  /// For feedforward `planned`: plan_for() of this run; if it is null, the plan is computed for the run.
  const PressurePlan* plan = nullptr;
  TrackingTrace* trace = nullptr;  ///< filled if it is not null
};

/// Returns the plan for a run's reference, computed with the model of the controller.
[[nodiscard]] PressurePlan plan_for(const TrackingRun& run);

/// The result over the measured cycles, for the finger itself (not for its noisy reading).
struct TrackingResult {
  double rmse_mm = 0;
  double worst_mm = 0;
  double pressure_mean_kpa = 0;  ///< mean of the commands
  double pressure_most_kpa = 0;
  double residual_rms_mm = 0;                 ///< residual of the running model
  double out_of_reach_share = 0;              ///< share of the ticks in which the reference was out of reach
  double cut_share = 0;                       ///< share of the ticks in which limits changed the request
  HealthState health = HealthState::unknown;  ///< the worst state during the run
};
[[nodiscard]] TrackingResult track(const TrackingRun& run);

/// Returns the model with each parameter multiplied by its own random factor, which is uniform in [1 -
/// relative, 1 + relative]. Whole numbers do not change.
[[nodiscard]] model::Model with_scatter(const model::Model& model, double relative, std::uint64_t seed);

/// Stability margins of a loop of PID and model. The model is linearised at the slopes of its hysteresis.
struct LoopMargins {
  double sensitivity = 0;   ///< Ms, the largest |1/(1+L)|; infinite for an unstable loop
  double crossover_hz = 0;  ///< lowest frequency at which |L| = 1
};
/// Returns the worst margins over the smallest and the largest instantaneous gain of the model. The gains are
/// taken on both sides of 0 kPa, within the pressure range. The loop includes the model's dead time, half a
/// tick for the hold, and the age `age_s` of the reading.
[[nodiscard]] LoopMargins loop_margins(const model::Model& model, const PidSettings& pid,
                                       const LimitSettings& limits, double tick_s, double age_s);

}  // namespace softgrip::control
