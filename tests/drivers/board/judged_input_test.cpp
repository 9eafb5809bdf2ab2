#include "drivers/board/judged_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace softgrip::drivers::judged_input_test {
namespace {

using model::Validity;

/// Tests a 4-20 mA input of a 16-bit board. The board reads -32768 if nothing is connected. The sensor
/// resembles the laser sensor HG-C1100: the current is highest at the near end of its range, and 3.75 mA
/// means that the sensor cannot measure.
class JudgedInputTest : public testing::Test {
 protected:
  JudgedInputTest() {
    map_.inputs.unit = ElectricalUnit::milliampere;
    map_.inputs.registers.kind = RegisterKind::int16;
    map_.inputs.scaling = {0, 0, 20000, 20};
    map_.inputs.raw_min = -32768;
    map_.inputs.raw_max = 32767;
    map_.inputs.error_raws = {-32768};
    wiring_.unit = ElectricalUnit::milliampere;
    wiring_.scaling = {4, 135, 20, 65};
    wiring_.valid_min = 4;
    wiring_.valid_max = 20;
    wiring_.error_codes = {{3.75, 0.05}};
  }

  JudgedInput judged(double raw, std::optional<std::uint16_t> status = std::nullopt) const {
    return judge(map_, wiring_, raw, status);
  }

  BoardMap map_;
  InputWiring wiring_;
};

TEST_F(JudgedInputTest, InsideTheRangeBothEndsIncluded) {
  EXPECT_EQ(judged(4000).validity, Validity::valid);
  EXPECT_DOUBLE_EQ(judged(4000).physical, 135);
  EXPECT_DOUBLE_EQ(judged(20000).physical, 65);
  EXPECT_DOUBLE_EQ(judged(12000).physical, 100);
  EXPECT_DOUBLE_EQ(judged(12000).electrical, 12);
  EXPECT_EQ(judged(20000).validity, Validity::valid);
  EXPECT_EQ(judged(3999).validity, Validity::out_of_range);
  EXPECT_EQ(judged(20001).validity, Validity::out_of_range);
}

TEST_F(JudgedInputTest, ErrorCodesBeforeRanges) {
  EXPECT_EQ(judged(3750).validity, Validity::sensor_error);
  EXPECT_EQ(judged(3700).validity, Validity::sensor_error);
  EXPECT_EQ(judged(3690).validity, Validity::out_of_range);
}

TEST_F(JudgedInputTest, BoardErrorCarriesNoValue) {
  for (const double raw :
       {-32768.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(judged(raw).validity, Validity::sensor_error);
    EXPECT_TRUE(std::isnan(judged(raw).physical));
  }
}

TEST_F(JudgedInputTest, StatusRegister) {
  map_.input_status = StatusBlock{.registers = {}, .ok = {0, 8}, .over = {1}, .under = {2}};
  EXPECT_EQ(judged(12000, std::uint16_t{0}).validity, Validity::valid);
  EXPECT_EQ(judged(12000, std::uint16_t{8}).validity, Validity::valid);
  EXPECT_EQ(judged(12000, std::uint16_t{1}).validity, Validity::out_of_range);
  EXPECT_EQ(judged(12000, std::uint16_t{2}).validity, Validity::out_of_range);
  EXPECT_EQ(judged(12000, std::uint16_t{3}).validity, Validity::sensor_error);
  // The status register indicates if the input is within the range of the board. In addition, the driver must
  // check the limits of the sensor.
  EXPECT_EQ(judged(1000, std::uint16_t{0}).validity, Validity::out_of_range);
  EXPECT_EQ(judged(3750, std::uint16_t{0}).validity, Validity::sensor_error);
  EXPECT_EQ(judged(3750, std::uint16_t{2}).validity, Validity::sensor_error);
}

}  // namespace
}  // namespace softgrip::drivers::judged_input_test
