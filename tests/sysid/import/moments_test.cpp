#include "sysid/import/moments.h"

#include <gtest/gtest.h>

#include <utility>

namespace softgrip::sysid::moments_test {
namespace {

double seconds_of(const char* text) {
  const auto moment = moment_of(text);
  return moment ? seconds(moment->time) : -1;
}

TEST(Moments, AreSecondsSince1970) {
  // output of the command `date -u -d 2024-05-31T12:00:00Z +%s`
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31T12:00:00Z"), 1717156800);
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31 12:00:00"), 1717156800);
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31T14:00:00+02:00"), 1717156800);
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31T07:00:00-0500"), 1717156800);
  EXPECT_DOUBLE_EQ(seconds_of("31.05.2024 12:00:00"), 1717156800);
  EXPECT_DOUBLE_EQ(seconds_of("2024/5/31 12:00"), 1717156800);
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31T12:00:00.25Z"), 1717156800.25);
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31T12:00:00,25"), 1717156800.25);
}

TEST(Moments, KeepNanoseconds) {
  const auto moment = moment_of("2024-05-31T12:00:00.123456789Z");
  ASSERT_TRUE(moment);
  EXPECT_EQ(moment->time % ns_per_s, 123456789);
}

TEST(Moments, TimeOfDayIsReadWithoutADate) {
  const auto moment = moment_of("23:59:59.5");
  ASSERT_TRUE(moment);
  EXPECT_FALSE(moment->dated);
  EXPECT_DOUBLE_EQ(seconds(moment->time), 86399.5);
}

TEST(Moments, TimeOfDayIsReadInSeveralNotations) {
  EXPECT_DOUBLE_EQ(seconds_of("12:59:50.5 PM"), 46790.5);
  EXPECT_DOUBLE_EQ(seconds_of("12:00:01 am"), 1);
  EXPECT_DOUBLE_EQ(seconds_of("1:00:00.25 p.m."), 46800.25);
  EXPECT_DOUBLE_EQ(seconds_of("12:59:50:020"), 46790.02);
  EXPECT_DOUBLE_EQ(seconds_of("2024-05-31 12:00:00:250"), 1717156800.25);
}

TEST(Moments, MonthNamesAreAccepted) {
  for (const char* text :
       {"31-May-2024 12:00:00", "31 May 2024 12:00:00", "31. Mai 2024 12:00:00", "May 31, 2024 12:00:00 PM",
        "2024-May-31 12:00:00", "31/may/2024 12:00:00", "May 31, 2024, 12:00:00"})
    EXPECT_DOUBLE_EQ(seconds_of(text), 1717156800) << text;
  EXPECT_DOUBLE_EQ(seconds_of("1 January 1970 00:00:01"), 1);
  EXPECT_DOUBLE_EQ(seconds_of("01-Sep-2024 00:00:00"), 1725148800);
}

TEST(Moments, TwoFieldsAreMinutesAndSeconds) {
  EXPECT_DOUBLE_EQ(seconds_of("01:02.5"), 62.5);
  EXPECT_TRUE(moment_of("01:02.5")->surely_minutes);
  EXPECT_TRUE(moment_of("75:00")->surely_minutes);
  EXPECT_FALSE(moment_of("12:34")->surely_minutes);
  EXPECT_TRUE(moment_of("12:34")->short_clock);
  EXPECT_FALSE(moment_of("12:34:56")->short_clock);
}

TEST(Moments, AmbiguousOrInvalidTextsAreRejected) {
  for (const char* text : {"05/31/2024 12:00:00", "2024-02-30 12:00:00", "25:00:00", "12:61", "2024-05-31",
                           "12", "1.5", "2024-05-31T12:00:00Zulu", "13:00:00 pm", "12:00:00:25",
                           "31-Foo-2024 12:00:00", "", "T", "::", "2024-13-01T00:00:00"})
    EXPECT_FALSE(moment_of(text)) << text;
}

TEST(Moments, DaysHaveNoTimeOfDay) {
  EXPECT_EQ(day_of("1970-01-03"), 2 * 86400 * ns_per_s);
  for (const char* same :
       {"31.05.2024", "2024/05/31", "31-May-2024", "May 31, 2024", "2024-05-31T00:00:00.000000"})
    EXPECT_EQ(day_of(same), day_of("2024-05-31")) << same;
  for (const char* none : {"05/31/2024", "2024-05-31 12:00:00", "00:00:00", "20240531", ""})
    EXPECT_FALSE(day_of(none)) << none;
}

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
}  // namespace softgrip::sysid::moments_test
