#include "control/tick/settings.h"

#include <algorithm>
#include <cmath>

namespace softgrip::control {

namespace {

using Texts = std::vector<std::string>;

void require(bool holds, Texts& problems, std::string sentence) {
  if (!holds) problems.push_back(std::move(sentence));
}

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}
bool not_negative(double value) {
  return std::isfinite(value) && value >= 0;
}

void check_limits(const LimitSettings& limits, const std::string& who, Texts& problems) {
  require(std::isfinite(limits.pressure_min_kpa) && std::isfinite(limits.pressure_max_kpa) &&
              limits.pressure_min_kpa < limits.pressure_max_kpa,
          problems, who + ": pressure_max_kpa must be above pressure_min_kpa");
  require(std::isfinite(limits.rest_kpa), problems, who + ": rest_kpa must be a number");
  require(positive(limits.slew_up_kpa_per_s) && positive(limits.slew_down_kpa_per_s), problems,
          who + ": slew_up_kpa_per_s and slew_down_kpa_per_s must be above 0");
  require(std::isfinite(limits.displacement_min_mm) && std::isfinite(limits.displacement_max_mm) &&
              limits.displacement_min_mm < limits.displacement_max_mm,
          problems, who + ": displacement_max_mm must be above displacement_min_mm");
  require(not_negative(limits.displacement_margin_mm), problems,
          who + ": displacement_margin_mm must not be negative");
}

void check_pid(const PidSettings& pid, const std::string& who, Texts& problems) {
  require(not_negative(pid.kp_kpa_per_mm) && not_negative(pid.ki_kpa_per_mm_s) &&
              not_negative(pid.kd_kpa_s_per_mm),
          problems, who + ": the gains of the PID controller must not be negative");
  require(not_negative(pid.derivative_filter_s), problems,
          who + ": derivative_filter_s must not be negative");
  require(pid.setpoint_weight >= 0 && pid.setpoint_weight <= 1, problems,
          who + ": setpoint_weight must be between 0 and 1");
  require(positive(pid.tracking_time_s), problems, who + ": tracking_time_s must be above 0");
}

void check_plausibility(const PlausibilitySettings& plausibility, const std::string& who, Texts& problems) {
  require(positive(plausibility.max_age_s), problems, who + ": max_age_s must be above 0");
  require(positive(plausibility.jump_mm) && plausibility.unsteady_jumps >= 2 &&
              plausibility.unsteady_jumps <= most_unsteady_jumps,
          problems, who + ": jump_mm must be above 0, and unsteady_jumps must be from 2 to 32");
  require(positive(plausibility.max_speed_mm_per_s), problems, who + ": max_speed_mm_per_s must be above 0");
  require(positive(plausibility.frozen_after_s) && positive(plausibility.frozen_command_kpa), problems,
          who + ": frozen_after_s and frozen_command_kpa must be above 0");
}

void check_channel(const ChannelSettings& channel, Texts& problems) {
  const std::string who = "channel '" + channel.name + "'";
  require(!channel.name.empty(), problems, "a channel has no name");
  require(!channel.model.blocks.empty(), problems, who + ": the model of the channel has no blocks");
  require(channel.displacement_used || channel.pressure_measured, problems,
          who + ": a channel that does not use its displacement must measure its pressure");
  check_limits(channel.limits, who, problems);
  check_pid(channel.pid, who, problems);
  check_plausibility(channel.plausibility, who, problems);
}

void check_detection(const DetectionSettings& detection, Texts& problems) {
  require(positive(detection.margin_mm), problems, "detection: margin_mm must be above 0");
  require(std::isnan(detection.model_rmse_mm) || detection.margin_mm >= 3 * detection.model_rmse_mm, problems,
          "detection: margin_mm must be at least three times the model's RMSE (model_rmse_mm)");
}

void check_faults(const FaultSettings& faults, Texts& problems) {
  require(faults.bus_down_cycles > 0 && faults.invalid_reading_cycles > 0 && faults.displacement_cycles > 0 &&
              faults.readback_cycles > 0,
          problems, "faults: each number of cycles after which a fault occurs must be at least 1");
  require(positive(faults.readback_tolerance_kpa) && not_negative(faults.readback_delay_s), problems,
          "faults: readback_tolerance_kpa must be above 0, and readback_delay_s must not be negative");
  require(positive(faults.pressure_tolerance_kpa) && not_negative(faults.pressure_delay_s), problems,
          "faults: pressure_tolerance_kpa must be above 0, and pressure_delay_s must not be negative");
}

}  // namespace

std::vector<std::string> settings_problems(const RigSettings& settings) {
  Texts problems;
  require(positive(settings.rate_hz), problems, "rate_hz must be above 0");
  require(!settings.channels.empty() && settings.channels.size() <= max_channels, problems,
          "a rig must have 1 to " + std::to_string(max_channels) + " channels");
  for (const ChannelSettings& channel : settings.channels) {
    check_channel(channel, problems);
    const auto same = [&](const ChannelSettings& other) { return other.name == channel.name; };
    require(std::count_if(settings.channels.begin(), settings.channels.end(), same) == 1, problems,
            "the name '" + channel.name + "' belongs to more than one channel");
  }
  require(positive(settings.rest_band_mm) && positive(settings.rest_time_s) &&
              settings.rest_timeout_s > settings.rest_time_s,
          problems, "rest: band_mm and time_s must be above 0, and timeout_s must be longer than time_s");
  check_detection(settings.detection, problems);
  check_faults(settings.faults, problems);
  return problems;
}

}  // namespace softgrip::control
