#include "sysid/identification/excitation_limits.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::excitation_limits_test {
namespace {

Estimate estimate(const std::string& name, bool free) {
  Estimate one;
  one.name = name;
  one.free = free;
  return one;
}

TEST(ExcitationLimits, NameTheFreeParametersWithoutExcitation) {
  Log ramp;
  for (int i = 0; i < 500; ++i) {
    ramp.time_s.push_back(0.02 * i);
    ramp.pressure_command_kpa.push_back(i < 200 ? 0 : 0.1 * (i - 200));
    ramp.displacement_mm.push_back(0);
  }
  const std::vector<Estimate> parameters{
      estimate("bouc_wen.alpha_mm_per_kpa", true), estimate("bouc_wen.beta_mm_per_kpa", true),
      estimate("bouc_wen.gamma_per_kpa", false), estimate("kelvin_voigt.k1_kpa_per_mm", true)};
  EXPECT_EQ(
      excitation_limits({ramp}, parameters),
      std::vector<std::string>{
          "the logs contain no unloading (decrease of the pressure), so hysteresis cannot be determined; the "
          "following parameters require the missing excitation: "
          "bouc_wen.beta_mm_per_kpa"});
  for (double& kpa : ramp.pressure_command_kpa) kpa += 1;
  const std::vector<std::string> both = excitation_limits({ramp}, parameters);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NE(both[1].find("require the missing excitation: kelvin_voigt.k1_kpa_per_mm"), std::string::npos)
      << both[1];
}

}  // namespace
}  // namespace softgrip::sysid::excitation_limits_test
