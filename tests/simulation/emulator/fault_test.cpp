#include "simulation/emulator/fault.h"

#include <gtest/gtest.h>

#include "simulation/emulator/fault_schedule.h"

namespace softgrip::simulation::fault_test {
namespace {

const std::vector<std::string> channels{"left", "right"};
constexpr Nanoseconds second = 1'000'000'000;

std::vector<FaultSpec> accepted(const std::string& text) {
  document::Problems problems;
  auto faults = read_faults(document::parse("faults.yaml", text, problems), channels, problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  return faults;
}

std::string refused(const std::string& text) {
  document::Problems problems;
  (void)read_faults(document::parse("faults.yaml", text, problems), channels, problems);
  EXPECT_FALSE(problems.empty()) << "accepted: " << text;
  return problems.format();
}

TEST(FaultsFile, ReadsEveryKind) {
  const auto faults = accepted(R"(faults:
  - {name: a, kind: lost_request, at_s: 1, for_s: 2}
  - {name: b, kind: no_reply, replies: 3}
  - {name: c, kind: late_reply, delay_s: 0.2}
  - {name: d, kind: dripped_reply, interval_s: 0.01}
  - {name: e, kind: cut_reply}
  - {name: f, kind: repeated_reply}
  - {name: g, kind: wrong_unit}
  - {name: h, kind: wrong_transaction}
  - {name: i, kind: wrong_length}
  - {name: j, kind: exception_reply, code: 4}
  - {name: s, kind: settling, settle_s: 1.5}
  - {name: t, kind: few_registers, most: 4}
  - {name: u, kind: stray_bytes, before: 1, behind: 2}
  - {name: k, kind: disconnect}
  - {name: l, kind: ignored_write}
  - {name: m, kind: sensor_stuck, channel: right}
  - {name: n, kind: sensor_jumping, by_mm: -3, interval_s: 0.5}
  - {name: o, kind: sensor_out_of_range, channel: left}
  - {name: p, kind: line_blocked}
  - {name: q, kind: line_leaking, share: 0.3}
  - {name: r, kind: object_removed}
)");
  ASSERT_EQ(faults.size(), 21U);
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(faults[i].kind), i);
  EXPECT_EQ(faults[0].at_s, 1);
  EXPECT_EQ(faults[0].for_s, 2);
  EXPECT_EQ(faults[1].replies, 3U);
  EXPECT_EQ(faults[2].delay_s, 0.2);
  EXPECT_EQ(faults[9].code, 4);
  EXPECT_EQ(faults[10].settle_s, 1.5);
  EXPECT_EQ(faults[11].most, 4);
  EXPECT_EQ(faults[12].before, 1);
  EXPECT_EQ(faults[12].behind, 2);
  EXPECT_EQ(faults[15].channel, 1U);
  EXPECT_EQ(faults[16].sensor.value_mm, -3);
  EXPECT_FALSE(faults[18].channel);
  EXPECT_EQ(faults[19].line.share, 0.3);
}

TEST(FaultsFile, ErrorStatesTheMistakeAndTheLine) {
  EXPECT_NE(refused("faults:\n  - {name: a, kind: noreply}\n").find("no_reply"), std::string::npos);
  EXPECT_NE(refused("faults:\n  - {name: a, kind: late_reply}\n").find("delay_s"), std::string::npos);
  EXPECT_NE(refused("faults:\n  - {name: a, kind: no_reply, delay_s: 1}\n").find("faults.yaml:2"),
            std::string::npos);
  EXPECT_NE(refused("faults:\n  - {name: a, kind: late_reply, delay: 1}\n").find("delay_s"),
            std::string::npos);
  EXPECT_NE(refused("faults:\n  - {name: a, kind: sensor_stuck, channel: middle}\n").find("channel"),
            std::string::npos);
  EXPECT_NE(refused("faults:\n  - {name: a, kind: no_reply}\n  - {name: a, kind: no_reply}\n").find(":3:"),
            std::string::npos);
  EXPECT_NE(refused("{}\n").find("faults"), std::string::npos);
  EXPECT_NE(refused("faults:\n  - {name: a, kind: no_reply, for_s: 0}\n").find("for_s"), std::string::npos)
      << "a fault of duration 0 is refused because it would never occur";
}

TEST(FaultSchedule, FaultTimesCountFromTheStart) {
  FaultSchedule schedule(accepted("faults:\n  - {name: a, kind: no_reply, at_s: 2, for_s: 1}\n"));
  EXPECT_FALSE(schedule.advance(100 * second))
      << "the clock of the fault schedule does not run before start()";
  schedule.start(100 * second);
  schedule.start(101 * second);
  EXPECT_EQ(schedule.next_change(), 102 * second);
  EXPECT_FALSE(schedule.advance(102 * second - 1));
  EXPECT_TRUE(schedule.advance(102 * second));
  EXPECT_TRUE(schedule.active(0));
  EXPECT_EQ(schedule.next_change(), 103 * second);
  EXPECT_TRUE(schedule.advance(103 * second));
  EXPECT_FALSE(schedule.active(0));
  EXPECT_FALSE(schedule.next_change()) << "the fault must occur only once";
}

TEST(FaultSchedule, TriggersAndClearsByName) {
  FaultSchedule schedule(
      accepted("faults:\n  - {name: a, kind: no_reply}\n  - {name: b, kind: no_reply, at_s: 9}\n"));
  schedule.start(0);
  EXPECT_TRUE(schedule.trigger("a", 5));
  EXPECT_TRUE(schedule.active(0));
  EXPECT_EQ(schedule.first_active(FaultKind::no_reply), 0U);
  EXPECT_TRUE(schedule.clear("a"));
  EXPECT_FALSE(schedule.active(0));
  EXPECT_TRUE(schedule.clear("b"));
  EXPECT_FALSE(schedule.advance(20 * second))
      << "the fault was cleared before its start, so it does not occur";
  EXPECT_FALSE(schedule.trigger("c", 0));
  EXPECT_FALSE(schedule.clear("c"));
}

TEST(FaultSchedule, AFaultEndsAfterTheGivenNumberOfResponses) {
  FaultSchedule schedule(accepted("faults:\n  - {name: a, kind: no_reply, replies: 2}\n"));
  schedule.trigger("a", 0);
  schedule.count_reply(0);
  EXPECT_TRUE(schedule.active(0));
  schedule.count_reply(0);
  EXPECT_FALSE(schedule.active(0));
  schedule.trigger("a", 0);
  schedule.count_reply(0);
  EXPECT_TRUE(schedule.active(0)) << "after a second trigger, the count of responses starts again at 0";
}

}  // namespace
}  // namespace softgrip::simulation::fault_test
