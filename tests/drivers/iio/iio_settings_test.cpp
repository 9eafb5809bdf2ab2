#include "drivers/iio/iio_settings.h"

#include <gtest/gtest.h>

namespace softgrip::drivers::iio_settings_test {
namespace {

TEST(IioChannel, NamesAreVoltagesCurrentsAndPressures) {
  EXPECT_EQ(unit_of_channel("voltage0"), ElectricalUnit::volt);
  EXPECT_EQ(unit_of_channel("voltage0-voltage1"), ElectricalUnit::volt);
  EXPECT_EQ(unit_of_channel("current3"), ElectricalUnit::milliampere);
  EXPECT_EQ(unit_of_channel("pressure"), ElectricalUnit::kilopascal);
  EXPECT_EQ(unit_of_channel("pressure1"), ElectricalUnit::kilopascal);
  for (const char* const other :
       {"", "voltage", "temp0", "../voltage0", "voltage0/..", "Voltage0", "pressures", "pressure/.."}) {
    EXPECT_FALSE(unit_of_channel(other).has_value()) << other;
  }
}

}  // namespace
}  // namespace softgrip::drivers::iio_settings_test
