#include "model/output_unit.h"

#include <gtest/gtest.h>

namespace softgrip::model::testing::output_unit_test {
namespace {

TEST(OutputUnit, TextsInMillimetresAreUnchanged) {
  for (const char* text : {"displacement [mm]", "mm/kPa", "0.3 mm, at most 5 % of the span"})
    EXPECT_EQ(in_unit(text, OutputUnit::mm), text);
}

TEST(OutputUnit, ReplacesEveryUnitInTextsForAnAngle) {
  EXPECT_EQ(in_unit("displacement [mm]", OutputUnit::deg), "bending angle [deg]");
  EXPECT_EQ(in_unit("mm/kPa", OutputUnit::deg), "deg/kPa");
  EXPECT_EQ(in_unit("1/mm", OutputUnit::deg), "1/deg");
  EXPECT_EQ(in_unit("error [mm\xc2\xb2/Hz], mm^2", OutputUnit::deg), "error [deg\xc2\xb2/Hz], deg^2");
}

TEST(OutputUnit, DoesNotChangeNamesThatContainTheUnit) {
  for (const char* text : {"gap_mm", "alpha_mm_per_kpa", "hammer", "comm", "mmHg", "displacements"})
    EXPECT_EQ(in_unit(text, OutputUnit::deg), text);
}

}  // namespace
}  // namespace softgrip::model::testing::output_unit_test
