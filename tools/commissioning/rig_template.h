#pragma once
// The rig file that `softgrip init` writes. `$NAME$` marks a value to fill in.

#include <string_view>

namespace softgrip::tools {

inline constexpr std::string_view rig_template =
    R"(# Written by softgrip init. Every key is described in docs/reference/rig-file.md; paths are relative to this file.
# What it could not know and you should look at: the limits, which terminal is which, what is safe in which phase.
#   softgrip check THIS_FILE            what is wrong with it
#   softgrip doctor --rig THIS_FILE     machine, board and sensors
#   softgrip calibrate --rig THIS_FILE --channel CHANNEL --sensor --write     the two points of a sensor
name: $name$
rate_hz: $rate_hz$

board:
$board$
channel_defaults:                  # what the channels share; what a channel says itself counts before it
  model: $model$   # what the controller believes of the free finger: softgrip identify makes yours
  feedforward: $feedforward$
  pid:                             # careful; softgrip tune --rig THIS_FILE finds better ones
    kp_kpa_per_mm: $kp$
    ki_kpa_per_mm_s: $ki$
    kd_kpa_s_per_mm: 0
    derivative_filter_s: 0.02
    setpoint_weight: 1
    anti_windup: back_calculation
    tracking_time_s: 0.5
  limits:
    pressure_min_kpa: $pressure_min$
    pressure_max_kpa: $pressure_max$            # what the finger bears
    slew_up_kpa_per_s: $slew_up$
    slew_down_kpa_per_s: $slew_down$
    displacement_min_mm: $displacement_min$          # by the model, within these pressures, and some room
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
  max_missed_commands: 10          # exchanges without a new command before the bus thread vents by itself
$watchdog$
faults:                            # cycles in a row before each is a fault
  bus_down_cycles: $bus_down$
  invalid_reading_cycles: 5
  displacement_cycles: 3
  readback_cycles: 10
  readback_tolerance_kpa: 1
  readback_delay_s: $readback_delay$
$pressure_fault$  slipped_cycles: 0                # 0: lost cycles are only counted
  model_unfit_is_fault: false
  unsteady_is_fault: true          # a sensor that jumps there and back, four times in a second

plausibility:                      # what a reading must be to be believed
  max_age_s: $max_age$
  max_speed_mm_per_s: $max_speed$          # three times what the model's finger can do
  jump_margin_mm: 0.5
  frozen_after_s: 1.0
  frozen_band_mm: 0
  frozen_command_kpa: 10

detection: {margin_mm: 1.0}        # a finger that moved so much less than the free model holds something
rest: {band_mm: 0.3, time_s: 0.3, timeout_s: 10}

model_health:                      # what a healthy residual looks like
  model_error_mm: 0.2
  correlation_time_s: 1.0
  noise_mm: 0.05
  unfit_mm: 3

real_time: {required: false, priority: 70, cpus: [], lock_memory: true, cpu_dma_latency_us: 0}
recorder: {mode: sequences, directory: $runs$}
socket: {path: $socket$, mode: "0660", sequence_directory: $sequences$}
)";

}  // namespace softgrip::tools
