#include "daemon/recording/csv_row.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>

namespace softgrip::daemon::csv_row_test {
namespace {

std::string decimal(double value) {
  std::array<char, longest_decimal> text{};
  return {text.data(), write_decimal(text.data(), value)};
}

std::string as_seconds(Nanoseconds duration) {
  std::array<char, longest_decimal> text{};
  return {text.data(), write_seconds(text.data(), duration)};
}

double parsed(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(result.ptr, text.data() + text.size()) << text;
  return value;
}

TEST(CsvRow, WritesNumbersWithAtMostSixDecimals) {
  EXPECT_EQ(decimal(0), "0");
  EXPECT_EQ(decimal(-0.0), "0");
  EXPECT_EQ(decimal(12), "12");
  EXPECT_EQ(decimal(12.5), "12.5");
  EXPECT_EQ(decimal(-3.25), "-3.25");
  EXPECT_EQ(decimal(0.000001), "0.000001");
  EXPECT_EQ(decimal(0.0000004), "0");
  EXPECT_EQ(decimal(-0.0000004), "0");
  EXPECT_EQ(decimal(0.9999996), "1");
  EXPECT_EQ(decimal(-0.9999996), "-1");
  EXPECT_EQ(decimal(100.000100), "100.0001");
}

TEST(CsvRow, LeavesTheCellEmptyForNaNAndInfinity) {
  EXPECT_EQ(decimal(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_EQ(decimal(std::numeric_limits<double>::infinity()), "");
}

TEST(CsvRow, NumbersReadBackToHalfAUnitOfTheLastDecimal) {
  const unsigned seed = 3;
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> exponent(-8, 9);
  for (int i = 0; i < 200'000; ++i) {
    const double value = (random() % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
    const std::string text = decimal(value);
    ASSERT_LE(text.size(), longest_decimal);
    ASSERT_NEAR(parsed(text), value, 0.5001e-6 + 1e-15 * std::abs(value)) << text;
    ASSERT_TRUE(text.find('.') == std::string::npos || text.back() != '0') << text;
  }
}

TEST(CsvRow, HugeNumbersKeepTheirValue) {
  for (const double value : {9.1e12, 1e15, -1e300, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(parsed(decimal(value)), value);
  }
}

TEST(CsvRow, TimesAreExact) {
  EXPECT_EQ(as_seconds(0), "0");
  EXPECT_EQ(as_seconds(5'000'000), "0.005");
  EXPECT_EQ(as_seconds(1'000'000'001), "1.000000001");
  EXPECT_EQ(as_seconds(-2'500'000'000), "-2.5");
  EXPECT_EQ(as_seconds(86'400'000'000'000), "86400");
}

TEST(CsvRow, HasOneCellPerColumn) {
  for (const bool with_pressure : {false, true}) {
    const CsvRows rows({"left", "right"}, with_pressure);
    Record record;
    record.at = 2'000'000'000;
    record.channel = 1;
    record.state = control::State::running;
    record.output.command_kpa = 20;
    record.output.displacement_mm = 3.5;
    record.output.pressure_kpa = 19.75;
    record.output.reference_mm = std::numeric_limits<double>::quiet_NaN();
    record.output.validity = model::Validity::valid;
    record.output.step = 4;
    record.output.slewing = true;
    std::string text;
    rows.append(text, record, 1'000'000'000);
    EXPECT_EQ(text, with_pressure ? "1,right,20,3.5,19.75,,0,0,0,0,0,running,4,valid,none,0,1\n"
                                  : "1,right,20,3.5,,0,0,0,0,0,running,4,valid,none,0,1\n");
    const std::string header = rows.header();
    EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(text.begin(), text.end(), ','));
    EXPECT_EQ(header.find(",pressure_kpa,") != std::string::npos, with_pressure);
  }
}

TEST(CsvRow, ATemperatureColumnExistsOnlyIfMeasured) {
  const CsvRows rows({"left"}, true, true);
  EXPECT_NE(rows.header().find(",pressure_kpa,temperature_c,reference_mm,"), std::string::npos);
  EXPECT_EQ(CsvRows({"left"}, true).header().find("temperature_c"), std::string::npos);
  Record record;
  record.output.displacement_mm = 3.5;
  record.output.pressure_kpa = 19.75;
  record.output.temperature_c = 21.5;
  record.output.validity = model::Validity::valid;
  std::string text;
  rows.append(text, record, 0);
  EXPECT_EQ(text, "0,left,0,3.5,19.75,21.5,0,0,0,0,0,0,starting,0,valid,none,0,0\n");
}

TEST(CsvRow, AnInvalidReadingLeavesTheCellEmpty) {
  const CsvRows rows({"left"}, false);
  Record record;
  record.output.displacement_mm = 3.5;
  record.output.validity = model::Validity::out_of_range;
  std::string text;
  rows.append(text, record, 0);
  EXPECT_EQ(text, "0,left,0,,0,0,0,0,0,0,starting,0,out_of_range,none,0,0\n");
}

}  // namespace
}  // namespace softgrip::daemon::csv_row_test
