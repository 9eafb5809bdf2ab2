#include "sysid/import/tdms_value.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>

namespace softgrip::sysid::tdms_value_test {
namespace {

template <class T>
double number_of(TdmsType type, T value) {
  EXPECT_EQ(size_of(type), sizeof(T));
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(T));
  return number_at(type, bytes.data());
}

TEST(TdmsValue, ReadsEachTypeOfNumber) {
  EXPECT_EQ(number_of(TdmsType::i8, std::int8_t{-3}), -3);
  EXPECT_EQ(number_of(TdmsType::i16, std::int16_t{-300}), -300);
  EXPECT_EQ(number_of(TdmsType::i32, std::int32_t{-70000}), -70000);
  EXPECT_EQ(number_of(TdmsType::i64, std::int64_t{-5000000000}), -5e9);
  EXPECT_EQ(number_of(TdmsType::u8, std::uint8_t{200}), 200);
  EXPECT_EQ(number_of(TdmsType::u16, std::uint16_t{60000}), 60000);
  EXPECT_EQ(number_of(TdmsType::u32, std::uint32_t{4000000000}), 4e9);
  EXPECT_EQ(number_of(TdmsType::u64, std::uint64_t{5000000000}), 5e9);
  EXPECT_EQ(number_of(TdmsType::f32, 1.5F), 1.5);
  EXPECT_EQ(number_of(TdmsType::f64_unit, 2.5), 2.5);
  EXPECT_EQ(number_of(TdmsType::boolean, std::uint8_t{7}), 1);
}

TEST(TdmsValue, TextAndUnknownTypesHaveNoSize) {
  EXPECT_EQ(size_of(TdmsType::string), 0U);
  EXPECT_EQ(size_of(static_cast<TdmsType>(99)), 0U);
}

TEST(TdmsValue, ReadsTimeStampsWithTheirFraction) {
  const std::uint64_t half = std::uint64_t{1} << 63U;
  const std::int64_t seconds = 3;
  std::array<char, 16> bytes{};
  std::memcpy(bytes.data(), &half, sizeof half);
  std::memcpy(bytes.data() + 8, &seconds, sizeof seconds);
  EXPECT_EQ(size_of(TdmsType::time), bytes.size());
  const TdmsStamp stamp = tdms_stamp_at(bytes.data());
  EXPECT_EQ(stamp.seconds, 3);
  EXPECT_EQ(stamp.fraction, 0.5);
  EXPECT_EQ(seconds_between({1, 0.25}, stamp), 2.25);
}

TEST(TdmsValue, TheTimeBetweenTwoStampsCannotOverflow) {
  using Limits = std::numeric_limits<std::int64_t>;
  EXPECT_NEAR(seconds_between({Limits::min(), 0}, {Limits::max(), 0}), 1.8446744e19, 1e13);
}

}  // namespace
}  // namespace softgrip::sysid::tdms_value_test
