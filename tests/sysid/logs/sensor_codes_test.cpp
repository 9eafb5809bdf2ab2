#include "sysid/logs/sensor_codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace softgrip::sysid::sensor_codes_test {
namespace {

TEST(SensorCodes, AreKnownOrRepeatedValuesFarFromAllReadings) {
  std::vector<double> column;
  for (int i = 0; i < 200; ++i) column.push_back(0.1 * i);
  EXPECT_EQ(sensor_codes(column), std::vector<double>{});
  for (const double code : {999.0, -9999.0, 32767.0, 1e30}) {
    std::vector<double> with = column;
    with[7] = code;
    EXPECT_EQ(sensor_codes(with), std::vector<double>{code});
  }
  std::vector<double> repeated = column;
  for (const std::size_t at : {3U, 50U, 120U}) repeated[at] = 777.7;
  EXPECT_EQ(sensor_codes(repeated), std::vector<double>{777.7});
  EXPECT_EQ(sensor_codes(repeated, CodeKinds::typical), std::vector<double>{});
  std::vector<double> spike = column;
  spike[7] = 777.7;
  EXPECT_EQ(sensor_codes(spike), std::vector<double>{});
  std::vector<double> in_range;
  for (int i = 0; i < 200; ++i) in_range.push_back(10.0 * i);
  in_range[7] = 999;
  EXPECT_EQ(sensor_codes(in_range), std::vector<double>{});
}

/// Returns 6000 readings of a finger that rests and then moves to 5.7 mm for 200 samples. The readings have a
/// resolution of 0.01 mm.
std::vector<double> long_rest() {
  std::vector<double> column;
  double position = 0;
  for (int i = 0; i < 6000; ++i) {
    position += 0.1 * ((i >= 5500 && i < 5700 ? 5.7 : 0) - position);
    column.push_back(std::round(100 * position + i % 5 - 2) / 100);
  }
  return column;
}

TEST(SensorCodes, PlateauOfAMotionIsNoCode) {
  EXPECT_EQ(sensor_codes(long_rest()), std::vector<double>{});
  for (const double code : {999.0, -50.0}) {
    std::vector<double> with = long_rest();
    for (const std::size_t at : {100U, 101U, 5650U, 5660U}) with[at] = code;
    EXPECT_EQ(sensor_codes(with), std::vector<double>{code}) << "a code during rest and during the motion";
  }
}

}  // namespace
}  // namespace softgrip::sysid::sensor_codes_test
