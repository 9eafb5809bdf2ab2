#include "sysid/logs/unit_factors.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::unit_factors_test {
namespace {

TEST(UnitFactors, OfPressureAreKnownBothWays) {
  EXPECT_EQ(pressure_units_apart(6.9), "psi and kPa");
  EXPECT_EQ(pressure_units_apart(0.145), "psi and kPa");
  EXPECT_EQ(pressure_units_apart(0.01), "bar and kPa");
  EXPECT_EQ(pressure_units_apart(3), "");
}

TEST(UnitFactors, SayWhichColumnWasProbablyMistaken) {
  EXPECT_NE(mistaken_unit(6.7).find("psi in a pressure column taken for kPa (a factor of 6.895)"),
            std::string::npos);
  EXPECT_NE(mistaken_unit(103).find("bar"), std::string::npos);
  EXPECT_NE(mistaken_unit(0.0385).find("inch in the displacement column"), std::string::npos);
  EXPECT_NE(mistaken_unit(0.1).find("cm in the displacement column"), std::string::npos);
  EXPECT_NE(mistaken_unit(1050).find("micrometres"), std::string::npos);
}

TEST(UnitFactors, AFingerOfAnotherSizeIsNone) {
  for (const double factor : {0.3, 0.7, 1.0, 1.5, 3.0, 5.0, 15.0}) EXPECT_EQ(mistaken_unit(factor), "");
}

}  // namespace
}  // namespace softgrip::sysid::unit_factors_test
