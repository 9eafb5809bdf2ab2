#include "control/tick/settings.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "tests/control/settings_fixture.h"

namespace softgrip::control {
namespace {

TEST(Settings, TheFixtureIsSound) {
  EXPECT_TRUE(settings_problems(two_finger_settings()).empty());
}

TEST(Settings, EachThatControlCannotTakeIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
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
       "measured pressure"},
      {[](RigSettings& s) { s.detection.margin_mm = 0; }, "margin_mm"},
      {[](RigSettings& s) { s.detection.model_rmse_mm = 0.4; }, "three times"},
      {[](RigSettings& s) { s.faults.bus_down_cycles = 0; }, "cycles"},
      {[](RigSettings& s) { s.rest_timeout_s = 0.1; }, "rest"},
  };
  for (const Case& test : cases) {
    RigSettings settings = two_finger_settings();
    test.spoil(settings);
    const auto problems = settings_problems(settings);
    ASSERT_FALSE(problems.empty()) << test.word;
    EXPECT_NE(problems.front().find(test.word), std::string::npos) << problems.front();
  }
}

}  // namespace
}  // namespace softgrip::control
