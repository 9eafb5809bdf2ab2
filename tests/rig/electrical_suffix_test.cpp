#include "rig/electrical_suffix.h"

#include <gtest/gtest.h>

namespace softgrip::rig::electrical_suffix_test {
namespace {

using drivers::ElectricalUnit;

TEST(ElectricalSuffix, IsTheUnitAtTheEndOfAKey) {
  EXPECT_EQ(suffix_of(ElectricalUnit::volt), "_v");
  EXPECT_EQ(suffix_of(ElectricalUnit::milliampere), "_ma");
  EXPECT_EQ(suffix_of(ElectricalUnit::kilopascal), "_kpa");
}

}  // namespace
}  // namespace softgrip::rig::electrical_suffix_test
