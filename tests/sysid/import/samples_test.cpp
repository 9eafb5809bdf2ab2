#include "sysid/import/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

// conversion_test.cpp tests the other rules of samples.h.
namespace softgrip::sysid::samples_test {
namespace {

/// Returns samples at the given times [s] with a command that changes in each gap of 2 s or more.
ForeignSamples samples_at(const std::vector<double>& time_s) {
  ForeignSamples samples;
  double command = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (i > 0 && time_s[i] - time_s[i - 1] >= 2) command += 30;
    samples[Role::time].push_back(time_s[i]);
    samples[Role::command].push_back(command);
    samples.row.push_back(i);
  }
  return samples;
}

TEST(ForeignSamples, SegmentsAreReportedInTheTimesOfTheOptions) {
  std::vector<double> time_s;
  for (int i = 0; i < 100; ++i) time_s.push_back(100 + 0.01 * i);
  for (int i = 0; i < 200; ++i) time_s.push_back(12345.25 + 0.01 * i);
  ForeignSamples samples = samples_at(time_s);
  for (std::size_t i = 0; i < 20; ++i) samples[Role::command][i] = std::nan("");
  ImportRemarks remarks;
  Mapping mapping;
  mapping.from_s = 0.1;
  ASSERT_FALSE(order_in_time(mapping, samples, remarks));
  complete_drive(samples, remarks);
  cut_at_holes(samples, remarks);
  EXPECT_NE(remarks.notes.back().find("12245.25 to 12247.24 s; to select another segment, use --from-s and "
                                      "--to-s: 0.2 to 0.99 s"),
            std::string::npos)
      << remarks.notes.back();
  EXPECT_EQ(samples.begin_s, 12245.25);
  EXPECT_EQ(samples[Role::time].front(), 0);
  ForeignSamples again = samples_at(time_s);
  mapping.from_s = 0.2;
  mapping.to_s = 0.99;
  ASSERT_FALSE(order_in_time(mapping, again, remarks));
  EXPECT_EQ(again.size(), 80U) << "the reported times select the complete segment";
}

/// The second gap changes the command by 1.7 % of the range of the file, but by 25 % of the range of the
/// samples after the first gap.
TEST(ForeignSamples, KeptSegmentIsSearchedForGapsAgain) {
  ForeignSamples samples;
  const auto add = [&](double begin_s, int count, double low_kpa, double range_kpa) {
    for (int i = 0; i < count; ++i) {
      samples[Role::time].push_back(begin_s + 0.01 * i);
      samples[Role::command].push_back(low_kpa + range_kpa * i / (count - 1));
      samples.row.push_back(samples.row.size());
    }
  };
  add(0, 100, 0, 60);
  add(5, 200, 10, 2);
  add(10, 300, 11, 2);
  ImportRemarks remarks;
  cut_at_holes(samples, remarks);
  EXPECT_EQ(samples.size(), 300U);
  EXPECT_EQ(samples.begin_s, 10);
  EXPECT_EQ(samples[Role::time].front(), 0);
  EXPECT_EQ(remarks.account.left_out[static_cast<std::size_t>(LeftOut::hole)], 300U);
  EXPECT_EQ(remarks.notes, std::vector<std::string>{
                               "the command changed during 2 gaps, so only the longest segment is kept: "
                               "10 to 12.99 s; to select another segment, use --from-s and --to-s: 0 to "
                               "0.99 s, 5 to 6.99 s"});
}

TEST(ForeignSamples, SamplesWithEqualTimeAreMergedIfNoValueDiffers) {
  const double none = std::nan("");
  ForeignSamples samples;
  samples[Role::time] = {0, 0, 1, 1, 2, 2, 3, 3};
  samples[Role::command] = {5, 5, 6, 6, 7, 8, 9, 9};
  samples[Role::displacement] = {none, 1, 2, none, none, 3, 4, 4};
  for (std::size_t i = 0; i < 8; ++i) samples.row.push_back(i);
  ImportRemarks remarks;
  ASSERT_FALSE(order_in_time({}, samples, remarks));
  EXPECT_EQ(samples[Role::time], (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(samples[Role::command], (std::vector<double>{5, 6, 7, 9}));
  EXPECT_EQ(samples[Role::displacement][0], 1);
  EXPECT_EQ(samples[Role::displacement][1], 2);
  EXPECT_TRUE(std::isnan(samples[Role::displacement][2])) << "the commands 7 and 8 differ";
  EXPECT_EQ(remarks.account.joined, 2U);
  EXPECT_EQ(remarks.account.left_out[static_cast<std::size_t>(LeftOut::repeated_time)], 2U)
      << "a complete repetition counts as a row with the time of the previous row";
}

}  // namespace
}  // namespace softgrip::sysid::samples_test
