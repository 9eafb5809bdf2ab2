#include "drivers/board/registers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "drivers/board/board_map.h"

namespace softgrip::drivers::registers_test {
namespace {

constexpr std::array kinds{RegisterKind::uint16, RegisterKind::int16, RegisterKind::uint32,
                           RegisterKind::int32, RegisterKind::float32};
constexpr std::array orders{WordOrder::high_first, WordOrder::low_first, WordOrder::high_first_bytes_swapped,
                            WordOrder::low_first_bytes_swapped};

double there_and_back(double raw, RegisterKind kind, WordOrder order) {
  std::array<std::uint16_t, 2> words{};
  encode(raw, kind, order, std::span(words).first(words_of(kind)));
  return decode(std::span(words).first(words_of(kind)), kind, order);
}

TEST(Registers, EncodeAndDecodeKnownBitPatterns) {
  std::array<std::uint16_t, 2> words{};
  encode(-2, RegisterKind::int16, WordOrder::high_first, words);
  EXPECT_EQ(words[0], 0xfffe);
  encode(100000, RegisterKind::uint32, WordOrder::high_first, words);
  EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0x0001, 0x86a0}));
  encode(100000, RegisterKind::int32, WordOrder::low_first, words);
  EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0x86a0, 0x0001}));
  encode(-1.5, RegisterKind::float32, WordOrder::high_first, words);
  EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0xbfc0, 0x0000}));
  EXPECT_EQ(decode(std::array<std::uint16_t, 2>{0x0000, 0xbfc0}, RegisterKind::float32, WordOrder::low_first),
            -1.5);
}

TEST(Registers, EncodeAndDecodeSwappedBytes) {
  std::array<std::uint16_t, 2> words{};
  encode(100000, RegisterKind::uint32, WordOrder::high_first_bytes_swapped, words);
  EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0x0100, 0xa086}));
  encode(100000, RegisterKind::uint32, WordOrder::low_first_bytes_swapped, words);
  EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0xa086, 0x0100}));
  encode(-1.5, RegisterKind::float32, WordOrder::low_first_bytes_swapped, words);
  EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0x0000, 0xc0bf}));
  for (const WordOrder order : {WordOrder::high_first_bytes_swapped, WordOrder::low_first_bytes_swapped}) {
    encode(-2, RegisterKind::int16, order, words);
    EXPECT_EQ(words[0], 0xfeff) << "the setting changes the order of the bytes even in a single register";
    EXPECT_EQ(decode(std::array<std::uint16_t, 1>{0x3412}, RegisterKind::uint16, order), 0x1234);
  }
}

TEST(Registers, IntegerKindsRoundTripAndSaturate) {
  for (const WordOrder order : orders) {
    for (const RegisterKind kind : kinds) {
      for (const double raw : {0.0, 1.0, 4095.0, 32767.0}) EXPECT_EQ(there_and_back(raw, kind, order), raw);
    }
    EXPECT_EQ(there_and_back(1e9, RegisterKind::uint16, order), 65535);
    EXPECT_EQ(there_and_back(-1, RegisterKind::uint16, order), 0);
    EXPECT_EQ(there_and_back(-1e9, RegisterKind::int16, order), -32768);
    EXPECT_EQ(there_and_back(1e12, RegisterKind::uint32, order), 4294967295.0);
    EXPECT_EQ(there_and_back(-1e12, RegisterKind::int32, order), -2147483648.0);
    EXPECT_EQ(there_and_back(2.5, RegisterKind::uint16, order), 3);
    for (const RegisterKind kind : kinds) {
      EXPECT_EQ(there_and_back(std::numeric_limits<double>::quiet_NaN(), kind, order), 0);
    }
  }
}

TEST(Registers, FloatsRoundTripExactly) {
  const unsigned seed = 7;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> values(-1e6F, 1e6F);
  for (int i = 0; i < 1000; ++i) {
    const auto raw = static_cast<double>(values(random));
    for (const WordOrder order : orders) EXPECT_EQ(there_and_back(raw, RegisterKind::float32, order), raw);
  }
}

// Converts a physical value to an electrical value and back, on rising and falling lines. The result must
// equal the physical value except for rounding.
TEST(Scaling, TwoPointsRoundTripForEitherSlope) {
  const unsigned seed = 11;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> values(-100, 100);
  for (int i = 0; i < 10000; ++i) {
    TwoPoints line{values(random), values(random), values(random), values(random)};
    // Skip lines whose two points are nearly equal, because such a line amplifies the rounding error without
    // bound. No real calibration has nearly equal points.
    if (std::abs(line.x1 - line.x0) < 0.1 || std::abs(line.y1 - line.y0) < 0.1) continue;
    const double y = values(random);
    EXPECT_NEAR(line.y_at(line.x_at(y)), y, 1e-9) << "seed " << seed << ", draw " << i;
    const double x = values(random);
    EXPECT_NEAR(line.x_at(line.y_at(x)), x, 1e-9) << "seed " << seed << ", draw " << i;
    EXPECT_EQ(line.y_at(line.x0), line.y0);
    EXPECT_NEAR(line.y_at(line.x1), line.y1, 1e-12);
  }
}

// Converts a physical value to an electrical value, to a raw register value, and back. The error must be at
// most half a step of the converter plus half a raw unit, for rising and for falling lines.
TEST(Scaling, ARoundTripThroughARegisterIsWithinHalfAStep) {
  const unsigned seed = 13;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  struct Case {
    RegisterKind kind;
    double raw_min;
    double raw_max;
    int bits;
  };
  const std::array cases{Case{RegisterKind::uint16, 0, 4095, 12}, Case{RegisterKind::uint16, 0, 65535, 16},
                         Case{RegisterKind::int16, -32768, 32767, 16},
                         Case{RegisterKind::int32, -1e6, 1e6, 14}, Case{RegisterKind::uint16, 0, 32760, 12}};
  for (const Case& one : cases) {
    for (const bool falling : {false, true}) {
      TerminalBlock block;
      block.registers = {.function = 3, .address = 0, .count = 1, .kind = one.kind};
      block.scaling = {one.raw_min, falling ? 20.0 : 4.0, one.raw_max, falling ? 4.0 : 20.0};
      block.raw_min = one.raw_min;
      block.raw_max = one.raw_max;
      block.bits = one.bits;
      const TwoPoints sensor{4, 85, 20, 15};  // the current is highest at the near end of the range
      // The tolerance is half a step of the converter plus half a raw unit, because a step is not always a
      // whole number of raw units.
      const double half_step_ma =
          16.0 / (std::exp2(one.bits) - 1) / 2 + 16.0 / (one.raw_max - one.raw_min) / 2;
      for (int i = 0; i < 500; ++i) {
        const double mm = 15 + 70 * share(random);
        const double raw =
            there_and_back(quantised_raw(block, sensor.x_at(mm)), one.kind, WordOrder::low_first);
        EXPECT_NEAR(sensor.y_at(block.scaling.y_at(raw)), mm, half_step_ma * 70.0 / 16.0 * 1.0001)
            << "seed " << seed;
      }
    }
  }
}

TEST(Scaling, QuantisationUsesTheStepsOfTheConverter) {
  TerminalBlock block;
  block.registers.kind = RegisterKind::float32;
  block.scaling = {0, 0, 10, 10};
  block.raw_min = 0;
  block.raw_max = 10;
  block.bits = 2;  // a converter with 2 bits has 4 levels: 0, 3.33, 6.67 and 10
  EXPECT_DOUBLE_EQ(quantised_raw(block, 4), 10.0 / 3);
  EXPECT_DOUBLE_EQ(quantised_raw(block, 11), 10);
  EXPECT_DOUBLE_EQ(quantised_raw(block, -1), 0);
  block.bits = 0;
  EXPECT_DOUBLE_EQ(quantised_raw(block, 4.2), 4.2);
}

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

TEST_F(JudgedInputTest, BothLimitsOfTheRangeAreValid) {
  EXPECT_EQ(judged(4000).validity, Validity::valid);
  EXPECT_DOUBLE_EQ(judged(4000).physical, 135);
  EXPECT_DOUBLE_EQ(judged(20000).physical, 65);
  EXPECT_DOUBLE_EQ(judged(12000).physical, 100);
  EXPECT_DOUBLE_EQ(judged(12000).electrical, 12);
  EXPECT_EQ(judged(20000).validity, Validity::valid);
  EXPECT_EQ(judged(3999).validity, Validity::out_of_range);
  EXPECT_EQ(judged(20001).validity, Validity::out_of_range);
}

TEST_F(JudgedInputTest, AnErrorCodeHasPriorityOverTheRange) {
  EXPECT_EQ(judged(3750).validity, Validity::sensor_error);
  EXPECT_EQ(judged(3700).validity, Validity::sensor_error);
  EXPECT_EQ(judged(3690).validity, Validity::out_of_range);
}

TEST_F(JudgedInputTest, AnErrorOfTheBoardHasNoValue) {
  for (const double raw :
       {-32768.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(judged(raw).validity, Validity::sensor_error);
    EXPECT_TRUE(std::isnan(judged(raw).physical));
  }
}

TEST_F(JudgedInputTest, CombinesTheStatusRegisterWithTheSensorLimits) {
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
}  // namespace softgrip::drivers::registers_test
