#include "sysid/import/moments.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::split_times_test {
namespace {

TableColumn column(const std::string& name, std::vector<double> values) {
  TableColumn made;
  made.name = name;
  made.values = std::move(values);
  return made;
}

/// If the two columns are the parts of one time, returns their sum [s]. Otherwise returns the values of the
/// first column.
std::vector<double> combined(const TableColumn& seconds, const TableColumn& rest, bool& is_one_time) {
  std::vector<TableColumn> columns{rest, seconds};
  std::vector<std::string> notes;
  combine_split_times(columns, notes);
  is_one_time = columns[0].is_part_of_time;
  EXPECT_EQ(notes.size(), is_one_time ? 1U : 0U);
  EXPECT_EQ(columns[1].unit, is_one_time ? "s" : "");
  EXPECT_EQ(columns[1].name, seconds.name)
      << "the combined column must keep its original name, because options refer to this name";
  return columns[1].values;
}

TEST(SplitTimes, SecondsAndNanosecondsOfOneNameAreOneTime) {
  for (const auto& [seconds, rest] :
       {std::pair{"header.stamp.sec", "header.stamp.nanosec"}, std::pair{"secs", "nsecs"},
        std::pair{"stamp_sec", "stamp_nsec"}, std::pair{"stamp.secs", "stamp.nsecs"},
        std::pair{"t (s)", "t (ns)"}, std::pair{"Time/Seconds", "Time/Nanoseconds"}}) {
    bool is_one_time = false;
    const auto values =
        combined(column(seconds, {7, 7, 8}), column(rest, {0, 500'000'000, 250'000'000}), is_one_time);
    EXPECT_TRUE(is_one_time) << seconds;
    EXPECT_EQ(values, (std::vector<double>{7, 7.5, 8.25}));
  }
}

TEST(SplitTimes, OtherNamesOrValuesAreNotCombined) {
  const std::vector<double> whole{7, 7, 8};
  const std::vector<double> rest{0, 5e8, 2.5e8};
  for (const auto& [seconds, nanoseconds] :
       {std::pair{column("a_sec", whole), column("b_nsec", rest)},
        std::pair{column("sec", whole), column("msec", rest)},
        std::pair{column("sec", {7, 7.5, 8}), column("nsec", rest)},
        std::pair{column("sec", {-1, 0, 1}), column("nsec", rest)},
        std::pair{column("sec", whole), column("nsec", {0, 1e9, 2e9})},
        std::pair{column("sec", whole), column("nsec", {0, 0.5, 0.25})}}) {
    bool is_one_time = true;
    EXPECT_EQ(combined(seconds, nanoseconds, is_one_time), seconds.values);
    EXPECT_FALSE(is_one_time) << seconds.name << " " << nanoseconds.name;
  }
}

TEST(SplitTimes, TimeWithAMissingPartIsMissing) {
  const double none = std::nan("");
  bool is_one_time = false;
  const auto values = combined(column("sec", {7, none, 8}), column("nsec", {none, 5, 0}), is_one_time);
  EXPECT_TRUE(is_one_time);
  EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[1]));
  EXPECT_EQ(values[2], 8);
}

}  // namespace
}  // namespace softgrip::sysid::split_times_test
