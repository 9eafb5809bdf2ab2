#include "sysid/import/clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/numbers.h"
#include "sysid/import/proposal.h"
#include "sysid/import/table_readers.h"

namespace softgrip::sysid::clock_test {
namespace {

/// Returns 500 times of a clock. The clock starts at `begin` and advances by `step`. When it reaches `limit`,
/// it jumps back by `period`.
std::vector<double> counter(double begin, double step, double limit, double period) {
  std::vector<double> values;
  for (int i = 0; i < 500; ++i) {
    double value = begin + step * i;
    while (value >= limit) value -= period;
    values.push_back(value);
  }
  return values;
}

ForeignTable table_of(const std::string& text) {
  document::Problems problems;
  auto table = parse_text_table("t.csv", text, {}, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

TEST(Overflow, CounterOverflowsAreContinued) {
  struct Case {
    double begin, step, limit, period, unit_s;
  };
  for (const Case& c :
       {Case{60000, 20, 65536, 65536, 1e-3}, Case{60000, 200, 65536, 65536, 1e-6},
        Case{30000, 20, 32768, 65536, 1e-3}, Case{4294960000, 20, 4294967296, 4294967296, 1e-3},
        Case{4294.9, 0.001, 4294.967296, 4294.967296, 1}, Case{86395, 0.02, 86400, 86400, 1},
        Case{16777000, 10, 16777216, 16777216, 1e-6}, Case{60, 0.02, 65.536, 65.536, 1}}) {
    std::vector<double> clock = counter(c.begin, c.step, c.limit, c.period);
    const auto overflow = continue_overflows(clock, c.unit_s);
    ASSERT_TRUE(overflow) << c.begin;
    EXPECT_NEAR(overflow->period, c.period, 1e-9 * c.period);
    EXPECT_GE(overflow->count, 1U);
    for (std::size_t i = 0; i < clock.size(); ++i)
      ASSERT_NEAR(clock[i], c.begin + c.step * static_cast<double>(i), 1e-6 * c.step) << c.begin << " " << i;
  }
}

TEST(Overflow, OtherBackwardStepsAreUnchanged) {
  std::vector<double> corrected = counter(0, 0.02, 5, 0.3);
  std::vector<double> two_runs = counter(0, 20, 5000, 5000);
  std::vector<double> lost_rows = counter(60000, 20, 65536, 65536);
  lost_rows.erase(lost_rows.begin() + 250, lost_rows.begin() + 290);
  for (std::vector<double>* clock : {&corrected, &two_runs, &lost_rows}) {
    const std::vector<double> before = *clock;
    EXPECT_FALSE(continue_overflows(*clock, 1e-3));
    EXPECT_EQ(*clock, before);
  }
}

std::string two_times(double slope, double offset) {
  std::string text = "time_s,set_kpa,clock_ms,tip_mm\n";
  for (int i = 0; i < 100; ++i)
    text += shortest(0.02 * i) + ",1," + shortest(1e3 * (offset + slope * 0.02 * i)) + ",2\n";
  return text;
}

TEST(SameClock, SeparatesADelayFromAnotherUnitOrOrigin) {
  struct Case {
    double slope, offset;
    bool same;
  };
  for (const Case& c : {Case{1, 0, true}, Case{1, 1e6, true}, Case{1, 0.1, false}, Case{1, 0.007, false},
                        Case{0.2, 0, false}}) {
    const ForeignTable table = table_of(two_times(c.slope, c.offset));
    EXPECT_EQ(time_columns(table), (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(same_clock(table, {}, 0, 2), c.same) << c.slope << " " << c.offset;
  }
}

TEST(SameClock, AScaleDoesNotMakeTwoClocksOfOne) {
  Mapping given;
  given[Role::time].scale = 0.1;
  const Proposal proposal = propose(table_of(two_times(1, 0)), given, true);
  EXPECT_EQ(proposal.mapping[Role::time].columns, std::vector<std::string>{"time_s"});
  EXPECT_TRUE(proposal.questions.empty()) << proposal.questions.front().text;
}

TEST(TimesOfRoles, NameTakesPrecedenceOverColumnOrder) {
  const auto times_of = [](const std::string& header) {
    const ForeignTable table = table_of(header + "\n0,0,0,0\n1,1,1,1\n2,2,2,2\n");
    Mapping mapping;
    for (const TableColumn& column : table.columns) {
      if (column.name.find("kpa") != std::string::npos) mapping[Role::command].columns = {column.name};
      if (column.name.find("mm") != std::string::npos) mapping[Role::displacement].columns = {column.name};
    }
    const auto times = times_of_roles(table, mapping, time_columns(table));
    return times ? std::vector<std::size_t>{(*times)[1], (*times)[3]} : std::vector<std::size_t>{};
  };
  EXPECT_EQ(times_of("t_cmd_s,t_tip_s,set_kpa,tip_mm"), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(times_of("time_a_s,set_kpa,time_b_s,tip_mm"), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(times_of("time_a_s,time_b_s,set_kpa,tip_mm"), std::vector<std::size_t>{});
}

TEST(SecondsOf, UsesTheUnitOfEachColumn) {
  const ForeignTable table = table_of("a_time_s,b_time_ms,x\n1,1000,0\n2,2000,0\n");
  EXPECT_EQ(seconds_of(table, {}, 0), (std::vector<double>{1, 2}));
  EXPECT_EQ(seconds_of(table, {}, 1), (std::vector<double>{1, 2}));
  EXPECT_FALSE(seconds_of(table, {}, 2));
}

TEST(SecondsOf, AScaleReplacesTheUnitsOfTheMappedTimes) {
  const ForeignTable table = table_of("a_time_s,b_time_ms,c_time_s,x_time\n1,1000,1,5\n2,2000,2,6\n");
  Mapping mapping;
  mapping[Role::time].columns = {"a_time_s", "b_time_ms", "x_time"};
  mapping[Role::time].scale = 0.1;
  EXPECT_EQ(seconds_of(table, mapping, 0), (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(seconds_of(table, mapping, 1), (std::vector<double>{100, 200}));
  EXPECT_EQ(seconds_of(table, mapping, 2), (std::vector<double>{1, 2})) << "this time is not mapped";
  EXPECT_EQ(seconds_of(table, mapping, 3), (std::vector<double>{0.5, 0.6000000000000001}));
}

TEST(TimeColumns, AColumnWithFewRisesIsNoTime) {
  std::string text = "time_s,coarse_s,held_s\n";
  for (int i = 0; i < 100; ++i)
    text += shortest(0.02 * i) + "," + std::to_string(i / 25) + "," + (i < 2 ? "0" : "0.1") + "\n";
  EXPECT_EQ(time_columns(table_of(text)), (std::vector<std::size_t>{0, 1}));
}

TEST(TimeColumns, StepsOfZeroAreNoRises) {
  std::string text = "time_s,mixed_s\n";
  for (int i = 0; i < 100; ++i) text += shortest(0.02 * i) + "," + (i % 20 < 10 ? "0.1" : "0.2") + "\n";
  EXPECT_EQ(time_columns(table_of(text)), std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace softgrip::sysid::clock_test
