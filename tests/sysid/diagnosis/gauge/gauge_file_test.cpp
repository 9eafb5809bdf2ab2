// Tests that the reader of gauge files rejects every invalid file. Each error message must state the line,
// the column and a correction.

#include "sysid/diagnosis/gauge/gauge_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace softgrip::sysid::gauge_file_test {
namespace {

std::string problems_of(const std::string& text) {
  document::Problems problems;
  EXPECT_FALSE(parse_gauge("gauge.csv", text, problems)) << text;
  return problems.format();
}

TEST(GaugeFile, AcceptsRepeatedUnorderedPositionsAndExtraColumns) {
  document::Problems problems;
  const auto gauge = parse_gauge("gauge.csv",
                                 "note,displacement_mm,gauge_mm\n"
                                 "\"a, b\",0.01,0\n,10.02,10\n,5.01,5\n,0.02,0\n",
                                 problems);
  ASSERT_TRUE(gauge) << problems.format();
  const std::vector<GaugeReading> expected{{0, 0.01, 1}, {10, 10.02, 1}, {5, 5.01, 1}, {0, 0.02, 1}};
  EXPECT_EQ(gauge->readings, expected);
  EXPECT_EQ(gauge->sha256.size(), 64U);
  EXPECT_EQ(distinct_positions(gauge->readings), (std::vector<double>{0, 5, 10}));
}

TEST(GaugeFile, WrittenFileIsReadBackUnchanged) {
  const std::vector<GaugeReading> readings{{0, 0.1, 200}, {2.5, 2.7, 200}, {1.0 / 3, 0.41, 7}};
  document::Problems problems;
  const auto gauge = parse_gauge("gauge.csv", format_gauge(readings), problems);
  ASSERT_TRUE(gauge) << problems.format();
  EXPECT_EQ(gauge->readings, readings);
}

TEST(GaugeFile, BendingAnglesAreStoredInDegrees) {
  const std::vector<GaugeReading> readings{{0, 0.1, 200}, {22.5, 22.7, 200}, {90, 91, 7}};
  document::Problems problems;
  const std::string text = format_gauge(readings, model::OutputUnit::deg);
  EXPECT_EQ(text.substr(0, text.find('\n')), "gauge_deg,angle_deg,samples");
  const auto gauge = parse_gauge("gauge.csv", text, problems);
  ASSERT_TRUE(gauge) << problems.format();
  EXPECT_EQ(gauge->readings, readings);
  EXPECT_EQ(gauge->output_unit, model::OutputUnit::deg);
  const auto radians = parse_gauge("gauge.csv", "gauge_rad,angle_rad\n0,0.1\n0.5,0.6\n1,1.1\n", problems);
  ASSERT_TRUE(radians) << problems.format();
  EXPECT_EQ(radians->output_unit, model::OutputUnit::deg);
  EXPECT_NEAR(radians->readings[1].position_mm, 28.6479, 1e-4);
  EXPECT_NEAR(radians->readings[1].reading_mm, 34.3775, 1e-4);
  EXPECT_EQ(parse_gauge("gauge.csv", format_gauge(readings), problems)->output_unit, model::OutputUnit::mm);
  EXPECT_EQ(positions_csv({0, 15}, model::OutputUnit::deg), "gauge_deg,angle_deg\n0,\n15,\n");
}

TEST(GaugeFile, ErrorMessagesStateLocationAndCorrection) {
  const std::string header = "gauge_mm,displacement_mm\n";
  const std::map<std::string, std::string> wrong{
      {"", "the file is empty"},
      {"gauge_m,displacement_mm\n0,0\n", "is 'gauge_m' meant?"},
      {"gauge_mm,gauge_mm,displacement_mm\n0,0,0\n", "a second column"},
      {"gauge_deg,displacement_mm\n0,0\n", "no column 'gauge_mm'"},
      {header + "0,0\n1,1\n", "2 different positions: at least 3"},
      {header + "0,0\n1,nan\n2,2\n", "gauge.csv:3:3"},
      {header + "0,0\n1,inf\n2,2\n", "gauge.csv:3:3"},
      {header + "0,0\n1,one\n2,2\n", "'one' in column 'displacement_mm' is not a number"},
      {header + "0,0\n1,\n2,2\n", "omit the row if the sensor gave no reading"},
      {header + "0,0,0,0\n", "if the numbers have a decimal comma, use a decimal point"},
      {header + "0,0\n1\n2,2\n", "gauge.csv:3:1"},
      {"gauge_mm,displacement_mm,samples\n0,0,1\n1,1,0\n2,2,1\n", "samples must be at least 1"},
  };
  for (const auto& [text, message] : wrong)
    EXPECT_NE(problems_of(text).find(message), std::string::npos) << text << problems_of(text);
}

TEST(GaugeFile, MissingFileIsReportedAsAProblem) {
  document::Problems problems;
  EXPECT_FALSE(read_gauge("/nowhere/gauge.csv", problems));
  EXPECT_EQ(problems.size(), 1U);
}

TEST(PlannedPositions, ExtendBeyondTheLogsAndRepeatThreeTimes) {
  for (const double largest : {0.7, 3.0, 12.4, 24.0, 31.7, 180.0, -24.0}) {
    const std::vector<double> positions = planned_positions(largest);
    std::map<double, int> times;
    for (const double p : positions) ++times[p];
    EXPECT_GE(times.size(), 9U) << largest;
    EXPECT_LE(times.size(), 14U) << largest;
    for (const auto& [position, count] : times) EXPECT_EQ(count, 3) << largest;
    EXPECT_EQ(positions.front(), 0);
    const double furthest = positions[times.size() - 1];
    EXPECT_GE(furthest / largest, 1.3) << largest;
    EXPECT_LT(furthest / largest, 1.55) << largest;
  }
  EXPECT_TRUE(planned_positions(0).empty());
  EXPECT_TRUE(planned_positions(NAN).empty());
}

TEST(PlannedPositions, UnfilledPositionFileIsRejected) {
  EXPECT_NE(problems_of(positions_csv(planned_positions(20))).find("empty cell"), std::string::npos)
      << problems_of(positions_csv(planned_positions(20)));
}

}  // namespace
}  // namespace softgrip::sysid::gauge_file_test
