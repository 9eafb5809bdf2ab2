#include "daemon/socket/status_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::daemon::under_pressure_test {
namespace {

using control::State;

class UnderPressure : public ::testing::Test {
 protected:
  UnderPressure() : channels_(2) {
    channels_[0].name = "left";
    channels_[1].name = "right";
    for (auto& channel : channels_) channel.limits.pressure_min_kpa = 2;
    snapshot_.channel_count = 2;
    snapshot_.state = State::idle;
    set(2, 2);
  }
  void set(double left_kpa, double right_kpa) {
    snapshot_.channels[0].command_kpa = left_kpa;
    snapshot_.channels[1].command_kpa = right_kpa;
    snapshot_.under_pressure = (left_kpa > 2 ? 1U : 0U) | (right_kpa > 2 ? 2U : 0U);
  }
  [[nodiscard]] nlohmann::ordered_json json() const { return under_pressure_json(channels_, snapshot_); }

  std::vector<control::ChannelSettings> channels_;
  Snapshot snapshot_;
};

TEST_F(UnderPressure, ReportsNothingIfTheControllerReportsNoPressure) {
  EXPECT_TRUE(json().is_null());
  set(30, 30);
  snapshot_.under_pressure = 0;
  EXPECT_TRUE(json().is_null()) << "a moving finger is not reported as pressurised";
}

TEST_F(UnderPressure, NamesPressurisedFingersAndTheCommandToVent) {
  set(2, 36.04);
  const auto idle = json();
  ASSERT_EQ(idle["channels"].size(), 1U);
  EXPECT_EQ(idle["channels"][0]["name"], "right");
  EXPECT_EQ(idle["command"], "softgrip release");
  EXPECT_EQ(idle["text"],
            "Fingers are pressurised: right 36.0 kPa. `softgrip release` vents them; a held part drops.");
  snapshot_.state = State::faulted;
  set(33, 36);
  EXPECT_EQ(json()["command"], "softgrip vent") << "a release request is refused in this state";
  EXPECT_NE(json()["text"].get<std::string>().find("left 33.0 kPa, right 36.0 kPa"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::daemon::under_pressure_test
