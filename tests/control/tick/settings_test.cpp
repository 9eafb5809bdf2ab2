#include "control/tick/settings.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/control/settings_fixture.h"

namespace softgrip::control::settings_test {
namespace {

TEST(Settings, TheFixtureSettingsAreValid) {
  EXPECT_TRUE(settings_problems(two_finger_settings()).empty());
}

TEST(Settings, EachInvalidSettingIsNamedInTheProblem) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  struct Case {
    std::function<void(RigSettings&)> spoil;
    const char* word;
  };
  const std::vector<Case> cases{
      {[](RigSettings& s) { s.rate_hz = 0; }, "rate_hz"},
      {[](RigSettings& s) { s.channels.clear(); }, "1 to 16"},
      {[](RigSettings& s) { s.channels[1].name = "left"; }, "more than one"},
      {[](RigSettings& s) { s.channels[0].name.clear(); }, "no name"},
      {[](RigSettings& s) { s.channels[0].model.blocks.clear(); }, "no blocks"},
      {[](RigSettings& s) { s.channels[0].limits.pressure_max_kpa = -1; }, "pressure_max_kpa"},
      {[nan](RigSettings& s) { s.channels[0].limits.pressure_min_kpa = nan; }, "pressure_max_kpa"},
      {[](RigSettings& s) { s.channels[0].limits.slew_up_kpa_per_s = 0; }, "slew"},
      {[](RigSettings& s) { s.channels[0].limits.displacement_max_mm = -2; }, "displacement_max_mm"},
      {[](RigSettings& s) { s.channels[0].limits.displacement_margin_mm = -2; }, "displacement_margin_mm"},
      {[nan](RigSettings& s) { s.channels[0].pid.kp_kpa_per_mm = nan; }, "gains"},
      {[](RigSettings& s) { s.channels[0].pid.setpoint_weight = 2; }, "setpoint_weight"},
      {[](RigSettings& s) { s.channels[0].plausibility.max_age_s = 0; }, "max_age_s"},
      {[](RigSettings& s) { s.channels[0].displacement_used = s.channels[0].pressure_measured = false; },
       "must measure its pressure"},
      {[](RigSettings& s) { s.detection.margin_mm = 0; }, "margin_mm"},
      {[](RigSettings& s) { s.detection.model_rmse_mm = 0.4; }, "three times"},
      {[](RigSettings& s) { s.faults.bus_down_cycles = 0; }, "cycles"},
      {[](RigSettings& s) { s.rest_timeout_s = 0.1; }, "rest"},
      {[infinite](RigSettings& s) { s.rate_hz = infinite; }, "rate_hz"},
      {[](RigSettings& s) {
         while (s.channels.size() <= max_channels) {
           s.channels.push_back(s.channels[0]);
           s.channels.back().name = "finger " + std::to_string(s.channels.size());
         }
       },
       "1 to 16"},
      {[infinite](RigSettings& s) { s.channels[0].limits.pressure_max_kpa = infinite; }, "pressure_max_kpa"},
      {[](RigSettings& s) { s.channels[0].limits.pressure_max_kpa = s.channels[0].limits.pressure_min_kpa; },
       "pressure_max_kpa"},
      {[](RigSettings& s) { s.channels[0].limits.slew_down_kpa_per_s = 0; }, "slew"},
      {[nan](RigSettings& s) { s.channels[0].limits.displacement_min_mm = nan; }, "displacement_max_mm"},
      {[infinite](RigSettings& s) { s.channels[0].limits.displacement_max_mm = infinite; },
       "displacement_max_mm"},
      {[](RigSettings& s) { s.channels[0].pid.ki_kpa_per_mm_s = -1; }, "gains"},
      {[](RigSettings& s) { s.channels[0].pid.kd_kpa_s_per_mm = -1; }, "gains"},
      {[](RigSettings& s) { s.channels[0].pid.derivative_filter_s = -1; }, "derivative_filter_s"},
      {[](RigSettings& s) { s.channels[0].pid.setpoint_weight = -0.1; }, "setpoint_weight"},
      {[](RigSettings& s) { s.channels[0].pid.tracking_time_s = 0; }, "tracking_time_s"},
      {[](RigSettings& s) { s.channels[0].plausibility.max_speed_mm_per_s = 0; }, "max_speed_mm_per_s"},
      {[](RigSettings& s) { s.channels[0].plausibility.frozen_after_s = 0; }, "frozen_after_s"},
      {[](RigSettings& s) { s.channels[0].plausibility.frozen_command_kpa = 0; }, "frozen_after_s"},
      {[](RigSettings& s) { s.faults.invalid_reading_cycles = 0; }, "cycles"},
      {[](RigSettings& s) { s.faults.displacement_cycles = 0; }, "cycles"},
      {[](RigSettings& s) { s.faults.readback_cycles = 0; }, "cycles"},
      {[](RigSettings& s) { s.faults.readback_tolerance_kpa = 0; }, "readback_tolerance_kpa"},
      {[](RigSettings& s) { s.faults.readback_delay_s = -1; }, "readback_tolerance_kpa"},
      {[](RigSettings& s) { s.faults.pressure_tolerance_kpa = 0; }, "pressure_tolerance_kpa"},
      {[](RigSettings& s) { s.faults.pressure_delay_s = -1; }, "pressure_tolerance_kpa"},
      {[](RigSettings& s) { s.rest_band_mm = 0; }, "rest"},
      {[](RigSettings& s) { s.rest_time_s = 0; }, "rest"},
  };
  for (const Case& test : cases) {
    RigSettings settings = two_finger_settings();
    test.spoil(settings);
    const auto problems = settings_problems(settings);
    ASSERT_FALSE(problems.empty()) << test.word;
    EXPECT_NE(problems.front().find(test.word), std::string::npos) << problems.front();
  }
}

TEST(Settings, AChannelWithDisplacementOrPressureIsValid) {
  RigSettings settings = two_finger_settings();
  settings.channels[0].displacement_used = false;
  settings.channels[0].pressure_measured = true;
  EXPECT_TRUE(settings_problems(settings).empty());
  settings.channels[0].displacement_used = true;
  settings.channels[0].pressure_measured = false;
  EXPECT_TRUE(settings_problems(settings).empty());
}

TEST(Settings, AnUnknownModelRmseIsAccepted) {
  RigSettings settings = two_finger_settings();
  settings.detection.model_rmse_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(settings_problems(settings).empty());
  settings.detection.model_rmse_mm = settings.detection.margin_mm / 3;
  EXPECT_TRUE(settings_problems(settings).empty()) << "a margin of exactly three times the RMSE is accepted";
}

}  // namespace
}  // namespace softgrip::control::settings_test
