#pragma once
// The text from which `softgrip init` creates a rig file. `$NAME$` in the text marks a value that `softgrip
// init` inserts.

#include <string_view>

namespace softgrip::tools {

inline constexpr std::string_view rig_template =
    R"(# Written by softgrip init. Every key is described in docs/reference/rig-file.md; paths are relative to this file.
# Check these values, which softgrip init cannot know: limits, terminals, and the safe action of each phase.
#   softgrip check THIS_FILE            reports errors in this file
#   softgrip doctor --rig THIS_FILE     checks computer, board and sensors
#   softgrip calibrate --rig THIS_FILE --channel CHANNEL --sensor --write     calibrates a sensor
name: $name$
rate_hz: $rate_hz$

board:
$board$
channel_defaults:                  # shared by all channels; keys of a channel override them
  model: $model$   # model of the finger's free motion; softgrip identify creates one
  feedforward: $feedforward$
  pid:                             # cautious values; softgrip tune --rig THIS_FILE finds better ones
    kp_kpa_per_mm: $kp$
    ki_kpa_per_mm_s: $ki$
    kd_kpa_s_per_mm: 0
    derivative_filter_s: 0.02
    setpoint_weight: 1
    anti_windup: back_calculation
    tracking_time_s: 0.5
  limits:
    pressure_min_kpa: $pressure_min$
    pressure_max_kpa: $pressure_max$            # highest permissible pressure of the finger
    slew_up_kpa_per_s: $slew_up$
    slew_down_kpa_per_s: $slew_down$
    displacement_min_mm: $displacement_min$          # range of the model at these pressures, and a reserve
    displacement_max_mm: $displacement_max$
    displacement_margin_mm: 2      # a reading farther out is a fault
  valve: $valve$
  sensor: $sensor$
$monitor$
channels:                          # terminals count from 0
$channels$
safety:                            # vent drops the part, hold keeps the pressure
  safe_action: {idle: vent, closing: vent, holding: hold, releasing: vent}
  on_emergency_stop: vent
  max_missed_commands: 10          # exchanges without a new command before the bus thread vents
$watchdog$
faults:                            # consecutive cycles before each is a fault
  bus_down_cycles: $bus_down$
  invalid_reading_cycles: 5
  displacement_cycles: 3
  readback_cycles: 10
  readback_tolerance_kpa: 1
  readback_delay_s: $readback_delay$
$pressure_fault$  overrun_cycles: 0                # 0: missed cycles are only counted
  model_unfit_is_fault: false
  unsteady_is_fault: true          # a sensor that jumps back and forth four times within 1 s

plausibility:                      # limits of a valid reading
  max_age_s: $max_age$
  max_speed_mm_per_s: $max_speed$          # three times the top speed of the model
  jump_margin_mm: 0.5
  frozen_after_s: 1.0
  frozen_band_mm: 0
  frozen_command_kpa: 10

detection: {margin_mm: 1.0}        # a displacement shortfall above this indicates a held part
rest: {band_mm: 0.3, time_s: 0.3, timeout_s: 10}

model_health:                      # properties of a healthy residual
  model_error_mm: 0.2
  correlation_time_s: 1.0
  noise_mm: 0.05
  unfit_mm: 3

real_time: {required: false, priority: 70, cpus: [], lock_memory: true, cpu_dma_latency_us: 0}
recorder: {mode: sequences, directory: $runs$}
socket: {path: $socket$, mode: "0660", sequence_directory: $sequences$}
)";

}  // namespace softgrip::tools
