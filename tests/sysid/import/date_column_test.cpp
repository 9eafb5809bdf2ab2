#include "sysid/import/date_column.h"

#include <gtest/gtest.h>

#include <utility>

namespace softgrip::sysid::date_column_test {
namespace {

constexpr Nanoseconds day = 86400 * ns_per_s;

TEST(DateColumn, NamesOfADateAreRecognised) {
  for (const char* name : {"Date", "date", "Datum", "Date [yyyy-mm-dd]"})
    EXPECT_TRUE(DateColumn::has_name(name)) << name;
  for (const char* name : {"Update", "calibration_date", "Time", ""})
    EXPECT_FALSE(DateColumn::has_name(name)) << name;
}

TEST(DateColumn, DaysAreCountedFromTheFirstDate) {
  DateColumn dates;
  for (const auto& [text, days] : {std::pair("2024-02-28", 0), std::pair("", 0), std::pair("2024-03-01", 2),
                                   std::pair("2024-03-01", 2), std::pair("2024-02-27", -1)}) {
    dates.read(text);
    EXPECT_TRUE(dates.is_readable());
    EXPECT_EQ(dates.since_first(), days * day) << text;
    EXPECT_FALSE(dates.take_unread_change());
  }
}

TEST(DateColumn, ChangesOfUnreadableDatesAreReportedOnce) {
  DateColumn dates;
  dates.read("05/31/2024");
  EXPECT_FALSE(dates.is_readable());
  EXPECT_FALSE(dates.take_unread_change()) << "the first date is no change";
  for (const char* text : {"06/01/2024", "2024-06-02", "06/03/2024"}) {
    dates.read(text);
    EXPECT_TRUE(dates.take_unread_change()) << text;
    EXPECT_FALSE(dates.take_unread_change());
    dates.read(text);
    EXPECT_FALSE(dates.take_unread_change());
    EXPECT_EQ(dates.since_first(), 0);
  }
}

}  // namespace
}  // namespace softgrip::sysid::date_column_test
