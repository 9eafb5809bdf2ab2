#include "sysid/changes/change_warnings.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::change_warnings_test {
namespace {

TEST(ChangeWarnings, StateTheLogAndTheNumber) {
  EXPECT_NE(closed_loops({"today"}).find("(closed loop) in today."), std::string::npos);
  EXPECT_TRUE(other_start("today").find("as today, so") != std::string::npos) << other_start("today");
  EXPECT_TRUE(unusual_log("today").starts_with("The error in today is larger")) << unusual_log("today");
  EXPECT_NE(unfamiliar_input(2.5).find("by a factor of up to 2.5 (mean square)"), std::string::npos);
  EXPECT_TRUE(unfamiliar_commands(0.125).starts_with("12 % of the measured pressures"))
      << unfamiliar_commands(0.125);
}

TEST(ChangeWarnings, UnusualGainStatesTheDirectionAndTheLimit) {
  EXPECT_TRUE(unusual_gain(-4.5, false).starts_with("The gain in the later logs is 4.5 % lower"))
      << unusual_gain(-4.5, false);
  EXPECT_TRUE(unusual_gain(8, true).starts_with("The gain in the later logs is at least 8 % higher"))
      << unusual_gain(8, true);
}

TEST(ChangeWarnings, UnusualZeroStatesTheDirectionAndTheUnit) {
  EXPECT_TRUE(unusual_zero(-4.5, 0.1, "deg").starts_with("The zero in the later logs is 4.5 deg lower than"))
      << unusual_zero(-4.5, 0.1, "deg");
}

}  // namespace
}  // namespace softgrip::sysid::change_warnings_test
