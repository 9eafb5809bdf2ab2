#include "sysid/diagnosis/verdict/reading_lead.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::reading_lead_test {
namespace {

TEST(WithDriveAhead, ShiftsTheDriveEarlierAndKeepsTheFirstSample) {
  const std::vector<Record> before = known_campaign(1);
  // The lead of 0.05 s is 2.5 samples long. Between two samples, the command is linear.
  const Record after = with_drive_ahead(before, 0.05).front();
  EXPECT_EQ(after.drive_kpa[0], before[0].drive_kpa[0]);
  for (std::size_t i = 1; i + 3 < after.size(); ++i)
    ASSERT_NEAR(after.drive_kpa[i], 0.5 * (before[0].drive_kpa[i + 2] + before[0].drive_kpa[i + 3]), 1e-9)
        << i;
}

TEST(WithDriveAhead, HidesTheLastReadingsWithoutAShiftedDrive) {
  const std::vector<Record> before = known_campaign(1);
  const Record after = with_drive_ahead(before, 0.1).front();
  const std::size_t last = after.size() - 1;
  EXPECT_TRUE(std::isfinite(after.reading_mm[last - 5]));
  for (std::size_t i = last - 4; i <= last; ++i) EXPECT_TRUE(std::isnan(after.reading_mm[i])) << i;
  EXPECT_EQ(after.readings, before[0].readings - 5);
}

TEST(WithDriveAhead, HeldDriveIsShiftedWithoutInterpolation) {
  std::vector<Record> before = known_campaign(1);
  before[0].held = true;
  const Record after = with_drive_ahead(before, 0.05).front();
  for (std::size_t i = 1; i + 3 < after.size(); ++i)
    ASSERT_EQ(after.drive_kpa[i], before[0].drive_kpa[i + 2]) << i;
}

}  // namespace
}  // namespace softgrip::sysid::reading_lead_test
