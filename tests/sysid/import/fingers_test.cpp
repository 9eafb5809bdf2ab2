#include "sysid/import/fingers.h"

#include <gtest/gtest.h>

#include <string>

#include "sysid/import/proposal.h"

namespace softgrip::sysid::fingers_test {
namespace {

using Names = std::vector<std::string>;

ForeignTable named(const Names& names) {
  ForeignTable table;
  for (const std::string& name : names) {
    table.columns.emplace_back();
    table.columns.back().name = name;
    table.columns.back().values = {0, 1, 2};
  }
  return table;
}

TEST(Fingers, FingersAreFoundFromColumnNames) {
  EXPECT_EQ(fingers_of(named({"t (s)", "P_left (kPa)", "P_right (kPa)", "tip_right (mm)", "tip_left (mm)"})),
            (Names{"left", "right"}));
  EXPECT_EQ(fingers_of(named({"time_s", "p1_kPa", "p2_kPa", "tip1_mm", "tip2_mm"})), (Names{"1", "2"}));
  EXPECT_EQ(fingers_of(named({"time_s", "thumbSet_kPa", "indexSet_kPa", "thumbTip_mm", "indexTip_mm"})),
            (Names{"thumb", "index"}));
  EXPECT_EQ(fingers_of(named({"t_s", "set_kpa", "ch0_pos_mm", "ch1_pos_mm"})), (Names{"0", "1"}));
}

TEST(Fingers, FingerNameMayEqualAUnit) {
  EXPECT_EQ(fingers_of(named({"t_s", "Finger A set (kPa)", "Finger A tip (mm)", "Finger B set (kPa)",
                              "Finger B tip (mm)"})),
            (Names{"a", "b"}));
}

TEST(Fingers, ColumnsOfOneFingerAreNotSplit) {
  EXPECT_EQ(fingers_of(named({"time_s", "set_kpa", "actual_pressure_kpa", "tip_mm"})), Names{});
  EXPECT_EQ(fingers_of(named({"time_s", "pd1_psi", "pd2_psi", "tip_mm"})), Names{});
  EXPECT_EQ(fingers_of(named({"time_s", "set_kpa", "tip_raw_mm", "tip_filtered_mm"})), Names{});
  EXPECT_EQ(fingers_of(named({"time_s", "set_kpa", "x_mm", "y_mm"})), Names{});
}

TEST(Fingers, ColumnBelongsToOneFingerOrToAll) {
  const Names fingers{"left", "right"};
  EXPECT_EQ(finger_of(named({"Left.tip (mm)"}).columns[0], fingers), "left");
  EXPECT_EQ(finger_of(named({"time_s"}).columns[0], fingers), "");
}

TEST(Fingers, ColumnsWithTheNumberOfAnotherFingerBelongToNone) {
  const ForeignTable table =
      named({"time_s", "pd1_psi", "pd2_psi", "pd3_psi", "supply_psi", "enc1_mm", "enc2_mm"});
  EXPECT_EQ(fingers_of(table), (Names{"1", "2"}));
  EXPECT_EQ(columns_of_no_finger(table, {"1", "2"}), Names{"pd3_psi"});
  EXPECT_EQ(columns_of_no_finger(table, {}), Names{});
  const Proposal proposal = propose(table, {}, true);
  EXPECT_FALSE(proposal.mapping[Role::command].given());
  ASSERT_EQ(proposal.questions.size(), 1U);
  EXPECT_EQ(proposal.questions.front().text,
            "the columns belong to 2 fingers: '1', '2'; no displacement belongs to 'pd3_psi'");
}

TEST(Tokens, LettersDigitsAndCapitalsDivideAName) {
  EXPECT_EQ(tokens_of("P1_left (kPa)"), (Names{"p", "1", "left", "k", "pa"}));
  EXPECT_EQ(tokens_of("thumbTip_mm"), (Names{"thumb", "tip", "mm"}));
}

}  // namespace
}  // namespace softgrip::sysid::fingers_test
