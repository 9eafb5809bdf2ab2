#pragma once
// A finger tracked in simulation: how well would this channel follow a sine? For studies, tuning and tests.

#include <cstdint>
#include <vector>

#include "control/feedforward/pressure_plan.h"
#include "control/tick/channel_settings.h"
#include "model/model.h"

namespace softgrip::control {

/// The finger's way over the measured cycles, one value per tick; times from the first of them.
struct TrackingTrace {
  std::vector<double> time_s;
  std::vector<double> reference_mm;
  std::vector<double> displacement_mm;
};

/// One run: rest, ramp to the lowest point of the sine, cycles. The board holds each command for a tick, from
/// `exchange_s` after the tick on; it reads in the same exchange, so a reading is a tick old when it is used.
struct TrackingRun {
  ChannelSettings settings;  ///< the controller, with the model it believes in
  model::Model finger;       ///< the truth
  double rate_hz = 200;
  double mean_mm = 13;
  double amplitude_mm = 7;
  double frequency_hz = 0.1;
  double settling_cycles = 1;  ///< not measured
  double measured_cycles = 2;
  double exchange_s = 0;        ///< less than a period
  double noise_mm = 0.03;       ///< of the sensor, white
  double reading_step_mm = 0;   ///< quantisation of the reading; 0: none
  double command_step_kpa = 0;  ///< quantisation of the output; 0: none
  std::uint64_t seed = 1;
  /// For feedforward `planned`: plan_for() of this run; if it is null, the plan is computed for the run.
  const PressurePlan* plan = nullptr;
  TrackingTrace* trace = nullptr;  ///< filled where there is one
};

/// The plan for a run's reference, by the model that its controller believes in.
[[nodiscard]] PressurePlan plan_for(const TrackingRun& run);

/// The result over the measured cycles, for the finger itself (not for its noisy reading).
struct TrackingResult {
  double rmse_mm = 0;
  double worst_mm = 0;
  double pressure_mean_kpa = 0;  ///< of the commands
  double pressure_most_kpa = 0;
  double residual_rms_mm = 0;                 ///< of the running model
  double out_of_reach_share = 0;              ///< of the ticks
  double cut_share = 0;                       ///< of the ticks in which limits changed the request
  HealthState health = HealthState::unknown;  ///< the worst that model health said
};
[[nodiscard]] TrackingResult track(const TrackingRun& run);

/// The model with every parameter multiplied by its own factor, even in [1 - relative, 1 + relative]; whole
/// numbers stay.
[[nodiscard]] model::Model with_scatter(const model::Model& model, double relative, std::uint64_t seed);

/// Margins of a PID on a model, linearised about the slopes between which its hysteresis moves.
struct LoopMargins {
  double sensitivity = 0;   ///< Ms, the largest of |1/(1+L)|; infinite for an unstable loop
  double crossover_hz = 0;  ///< lowest frequency at which |L| = 1
};
/// The worst over the smallest and the largest instantaneous gain that the model shows on both sides of 0
/// kPa, as far as the pressure range reaches, with the model's dead time, the hold's half tick and `age_s` of
/// the reading.
[[nodiscard]] LoopMargins loop_margins(const model::Model& model, const PidSettings& pid,
                                       const LimitSettings& limits, double tick_s, double age_s);

}  // namespace softgrip::control
