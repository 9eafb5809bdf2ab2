#include "sysid/logs/finer_record.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::finer_record_test {
namespace {

Log log() {
  Log log;
  log.name = "log";
  log.time_s = {0, 1, 3};
  log.pressure_command_kpa = {0, 10, 30};
  log.displacement_mm = {0, 1, 3};
  return log;
}

TEST(FinerRecord, GoesStraightBetweenSamplesAndKnowsNoReadingThere) {
  const Record record = make_records({log()}, {}).front();
  const Record fine = finer_record(record, 2);
  ASSERT_EQ(fine.size(), 5U);
  EXPECT_EQ(fine.time_s, (std::vector<double>{0, 0.5, 1, 2, 3}));
  EXPECT_EQ(fine.duration_s, (std::vector<double>{0, 0.5, 0.5, 1, 1}));
  EXPECT_EQ(fine.drive_kpa, (std::vector<double>{0, 5, 10, 20, 30}));
  EXPECT_TRUE(std::isnan(fine.reading_mm[1]));
  EXPECT_EQ(fine.reading_mm[2], record.reading_mm[1]);
  EXPECT_EQ(finer_record(record, 1).time_s, record.time_s);
}

TEST(FinerRecord, AHeldDriveStaysWhereItWas) {
  const Record fine = finer_record(make_records({log()}, {.held = true}).front(), 2);
  EXPECT_EQ(fine.drive_kpa, (std::vector<double>{0, 0, 10, 10, 30}));
}

}  // namespace
}  // namespace softgrip::sysid::finer_record_test
