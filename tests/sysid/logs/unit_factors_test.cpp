#include "sysid/logs/unit_factors.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace softgrip::sysid::unit_factors_test {
namespace {

TEST(UnitFactors, PressureFactorsAreRecognisedInBothDirections) {
  EXPECT_EQ(pressure_units_apart(6.9), "psi and kPa");
  EXPECT_EQ(pressure_units_apart(0.145), "psi and kPa");
  EXPECT_EQ(pressure_units_apart(0.01), "bar and kPa");
  EXPECT_EQ(pressure_units_apart(3), "");
}

TEST(UnitFactors, MessageNamesTheColumnWithTheWrongUnit) {
  EXPECT_NE(mistaken_unit(6.7, model::OutputUnit::mm)
                .find("a pressure column in psi was read as kPa (a factor of 6.895)"),
            std::string::npos);
  EXPECT_NE(mistaken_unit(103, model::OutputUnit::mm).find("bar"), std::string::npos);
  EXPECT_NE(mistaken_unit(0.0385, model::OutputUnit::mm).find("displacement column in inch"),
            std::string::npos);
  EXPECT_NE(mistaken_unit(0.1, model::OutputUnit::mm).find("displacement column in cm"), std::string::npos);
  EXPECT_NE(mistaken_unit(1050, model::OutputUnit::mm).find("micrometres"), std::string::npos);
}

TEST(UnitFactors, TypicalSizeRatiosAreNoUnitError) {
  for (const double factor : {0.3, 0.7, 1.0, 1.5, 3.0, 5.0, 15.0})
    EXPECT_EQ(mistaken_unit(factor, model::OutputUnit::mm), "");
}

}  // namespace
}  // namespace softgrip::sysid::unit_factors_test
