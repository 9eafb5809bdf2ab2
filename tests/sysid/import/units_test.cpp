#include "sysid/import/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::units_test {
namespace {

struct Case {
  const char* text;
  Quantity quantity;
  double value;
  double expected;
};

class Units : public ::testing::TestWithParam<Case> {};

TEST_P(Units, AreConvertedToTheUnitOfALog) {
  const Case& c = GetParam();
  const auto unit = unit_named(c.text, c.quantity);
  ASSERT_TRUE(unit) << c.text;
  EXPECT_NEAR(unit->factor * c.value + unit->offset, c.expected, 1e-9 * (1 + std::abs(c.expected))) << c.text;
}

// The expected conversion factors are taken from NIST SP 811, appendix B.
INSTANTIATE_TEST_SUITE_P(
    ForeignTable, Units,
    testing::Values(
        Case{"s", Quantity::time, 1.5, 1.5}, Case{"msec", Quantity::time, 20, 0.02},
        Case{"\xc2\xb5s", Quantity::time, 5, 5e-6}, Case{"ns", Quantity::time, 3, 3e-9},
        Case{"min", Quantity::time, 2, 120}, Case{"hours", Quantity::time, 1, 3600},
        Case{"days", Quantity::time, 1, 86400}, Case{"PSI", Quantity::pressure, 10, 68.94757293168361},
        Case{"psig", Quantity::pressure, 1, 6.894757293168361}, Case{"Bar", Quantity::pressure, 0.5, 50},
        Case{"mbar", Quantity::pressure, 1013.25, 101.325}, Case{"Pa", Quantity::pressure, 1000, 1},
        Case{"hPa", Quantity::pressure, 1013.25, 101.325}, Case{"MPa", Quantity::pressure, 0.1, 100},
        Case{"mPa", Quantity::pressure, 1e6, 1}, Case{"atm", Quantity::pressure, 1, 101.325},
        Case{"mmHg", Quantity::pressure, 1, 0.133322387415}, Case{"inH2O", Quantity::pressure, 1, 0.24908891},
        Case{"kgf/cm2", Quantity::pressure, 1, 98.0665}, Case{"cm", Quantity::displacement, 1.2, 12},
        Case{"m", Quantity::displacement, 0.012, 12}, Case{"\xce\xbcm", Quantity::displacement, 12000, 12},
        Case{"inch", Quantity::displacement, 0.5, 12.7}, Case{"Degrees", Quantity::displacement, 30, 30},
        Case{"\xc2\xb0", Quantity::displacement, 30, 30},
        Case{"rad", Quantity::displacement, 1, 57.29577951308232},
        Case{"mrad", Quantity::displacement, 1000, 57.29577951308232},
        Case{"mil", Quantity::displacement, 100, 2.54},
        Case{"\xc2\xb0"
             "C",
             Quantity::temperature, 21, 21},
        Case{"K", Quantity::temperature, 293.15, 20}, Case{"deg F", Quantity::temperature, 212, 100}));

TEST(Unit, UnknownOrMismatchedUnitsAreRejected) {
  EXPECT_FALSE(unit_named("psi", Quantity::displacement));
  EXPECT_FALSE(unit_named("V", Quantity::pressure));
  EXPECT_FALSE(unit_named("furlong"));
  EXPECT_FALSE(unit_named(""));
  EXPECT_TRUE(is_raw_unit("mV"));
  EXPECT_TRUE(is_raw_unit("Counts"));
  EXPECT_FALSE(is_raw_unit("mm"));
}

TEST(SplitUnit, FindsNameAndUnit) {
  const auto is = [](const char* column, const char* name, const char* unit,
                     std::optional<Quantity> quantity = {}) {
    const NameAndUnit split = split_unit(column, quantity);
    EXPECT_EQ(split.name, name) << column;
    EXPECT_EQ(split.unit, unit) << column;
  };
  is("P [psi]", "P", "psi");
  is("Time (s)", "Time", "s");
  is("p/kPa", "p", "kPa");
  is("Tip, mm", "Tip", "mm");
  is("set_kpa", "set", "kpa");
  is("laser_V", "laser", "V");
  is("strange [furlong]", "strange", "furlong");
  is("Tip", "Tip", "");
  is("M(:,2)", "M(:,2)", "");
}

TEST(SplitUnit, AcceptsOnlyUnitsOfTheQuantity) {
  EXPECT_EQ(split_unit("p_in").unit, "");
  EXPECT_EQ(split_unit("p_in", Quantity::pressure).unit, "");
  EXPECT_EQ(split_unit("tip_in", Quantity::displacement).unit, "in");
  EXPECT_EQ(split_unit("temp_c", Quantity::temperature).unit, "c");
  EXPECT_EQ(split_unit("time_h", Quantity::time).unit, "h");
}

}  // namespace
}  // namespace softgrip::sysid::units_test
