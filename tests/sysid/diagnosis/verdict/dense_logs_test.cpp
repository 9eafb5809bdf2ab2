#include "sysid/diagnosis/verdict/dense_logs.h"

#include <gtest/gtest.h>

#include "sysid/logs/resampled_record.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::dense_logs_test {
namespace {

std::vector<Record> records_at(double rate_hz, std::size_t count) {
  const Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, rate_hz, 0.02, 7);
  return make_records(std::vector<Log>(count, log), {});
}

TEST(DenseLogs, ManyReadingsCloseTogetherAreAveragedAndItIsSaid) {
  std::vector<Record> records = records_at(2000, 1);
  ASSERT_GT(records.front().readings, enough_readings);
  const double length_s = records.front().length_s();
  std::vector<std::string> warnings;
  EXPECT_TRUE(average_dense(records, warnings));
  EXPECT_NEAR(records.front().mean_interval_s(), averaged_interval_s, 1e-9);
  EXPECT_NEAR(records.front().length_s(), length_s, averaged_interval_s);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings.front().find("2000 samples per second"), std::string::npos) << warnings.front();
}

TEST(DenseLogs, LongLogsAndShortOnesAreLeftAlone) {
  std::vector<std::string> warnings;
  std::vector<Record> long_campaign = records_at(100, 12);
  EXPECT_FALSE(average_dense(long_campaign, warnings));
  std::vector<Record> short_one = records_at(500, 1);
  ASSERT_LE(short_one.front().readings, enough_readings);
  EXPECT_FALSE(average_dense(short_one, warnings));
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace softgrip::sysid::dense_logs_test
