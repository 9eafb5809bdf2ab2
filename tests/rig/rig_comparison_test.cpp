#include "rig/check.h"

#include <gtest/gtest.h>

#include <regex>

#include "control/sequences/sequence_file.h"
#include "tests/support/files.h"

namespace softgrip::rig::rig_comparison_test {
namespace {

using document::Problems;

const std::string folder = std::string(SOFTGRIP_SOURCE_DIR) + "/config/";

class RigComparisonTest : public ::testing::Test {
 protected:
  RigComparisonTest() { text = test::text_of(folder + "rig.yaml"); }
  void change(const std::string& pattern, const std::string& to) {
    const std::string changed = std::regex_replace(text, std::regex(pattern), to);
    ASSERT_NE(changed, text) << pattern;
    text = changed;
  }
  const Problems& compare() {
    problems = {};
    const document::Document document = document::parse(folder + "rig.yaml", text, problems);
    rig = read_rig(document, problems);
    EXPECT_TRUE(rig) << problems.format();
    problems = {};
    if (rig) compare_limits(document, *rig, problems);
    return problems;
  }

  std::string text;
  Problems problems;
  std::optional<RigFile> rig;
};

TEST_F(RigComparisonTest, TheShippedRigCausesNoWarning) {
  EXPECT_EQ(compare().format(), "");
}

TEST_F(RigComparisonTest, WarnsIfMaximumPressureLeavesTheDisplacementRange) {
  change("displacement_max_mm: 35", "displacement_max_mm: 3");
  ASSERT_EQ(compare().warnings().size(), 2U) << problems.format();
  const document::Problem& first = problems.warnings()[0];
  EXPECT_NE(first.message.find("`pressure_max_kpa` the model of channel `left` goes to 31 mm"),
            std::string::npos)
      << first.message;
  EXPECT_EQ(first.line_text, "    pressure_max_kpa: 60");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(first.hint, found, std::regex("pressure_max_kpa: ([\\d.]+)"))) << first.hint;
  const double advised = std::stod(found[1]);
  EXPECT_GT(advised, 3);
  EXPECT_LT(advised, 20);
  change("pressure_max_kpa: 60", "pressure_max_kpa: " + found[1].str());
  EXPECT_EQ(compare().format().find("displacement_max_mm"), std::string::npos)
      << "the value that the warning advises must not cause another warning";
}

TEST_F(RigComparisonTest, WarnsIfMinimumPressureLeavesTheDisplacementRange) {
  change("pressure_min_kpa: 0", "pressure_min_kpa: -40");
  change("_kpa: \\[0, 100\\]", "_kpa: [-100, 100]");
  change("displacement_min_mm: -1", "displacement_min_mm: -2");
  ASSERT_EQ(compare().warnings().size(), 2U) << problems.format();
  const document::Problem& first = problems.warnings()[0];
  EXPECT_NE(first.message.find("`pressure_min_kpa` the model of channel `left` goes to -"), std::string::npos)
      << first.message;
  EXPECT_EQ(first.line_text, "    pressure_min_kpa: -40");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(first.hint, found, std::regex("pressure_min_kpa: (-[\\d.]+)"))) << first.hint;
  change("pressure_min_kpa: -40", "pressure_min_kpa: " + found[1].str());
  EXPECT_EQ(compare().format().find("displacement_min_mm"), std::string::npos)
      << "the value that the warning advises must not cause another warning";
}

TEST_F(RigComparisonTest, WarnsAboutAMaximumSpeedThatNoFingerReaches) {
  change("max_speed_mm_per_s: 500", "max_speed_mm_per_s: 50000");
  ASSERT_EQ(compare().warnings().size(), 2U) << problems.format();
  const document::Problem& first = problems.warnings()[0];
  EXPECT_EQ(first.line_text, "  max_speed_mm_per_s: 50000");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(first.hint, found, std::regex("max_speed_mm_per_s: ([\\d.]+)")))
      << first.hint;
  change("max_speed_mm_per_s: 50000", "max_speed_mm_per_s: " + found[1].str());
  EXPECT_EQ(compare().format(), "");
}

TEST_F(RigComparisonTest, WarnsIfAChannelCannotDetectABurstLine) {
  change("    pressure_monitor: \\{input: 5\\}\n", "");
  change("\n  pressure_monitor: .*", "");
  change("    pressure_monitor: \\{input: 4\\}\n",
         "    pressure_monitor: {input: 4, at_v: [0, 10], is_kpa: [0, 100], valid_v: [-0.2, 10]}\n");
  ASSERT_EQ(compare().warnings().size(), 1U) << problems.format();
  EXPECT_NE(problems.warnings()[0].message.find("channel `right` has no `pressure_monitor`"),
            std::string::npos);
  EXPECT_NE(problems.warnings()[0].hint.find("pressure_monitor"), std::string::npos);
  EXPECT_TRUE(sees_burst_line(*rig, 0));
  EXPECT_FALSE(sees_burst_line(*rig, 1));
}

TEST_F(RigComparisonTest, WarnsIfThePressureMonitorIsNotEvaluated) {
  change("pressure_cycles: 20 ", "pressure_cycles: 0 ");
  ASSERT_EQ(compare().warnings().size(), 2U) << problems.format();
  EXPECT_NE(problems.warnings()[0].hint.find("pressure_cycles: 20"), std::string::npos);
}

TEST_F(RigComparisonTest, WarnsAboutAGripThatCannotDetectABurstLine) {
  change("pressure_cycles: 20 ", "pressure_cycles: 0 ");
  compare();
  document::Problems none;
  const auto pick = control::load_sequence(folder + "sequences/pick_stone.yaml", none);
  ASSERT_TRUE(pick) << none.format();
  document::Problems told;
  compare_grips(*pick, *rig, told);
  ASSERT_EQ(told.warnings().size(), 1U) << "the problem is reported once, not for each finger";
  EXPECT_NE(told.warnings()[0].file.find("pick_stone.yaml"), std::string::npos);
  EXPECT_NE(told.warnings()[0].message.find("would also report HOLDING with a burst line"),
            std::string::npos);
  EXPECT_NE(told.warnings()[0].hint.find("rig.yaml: under `faults`"), std::string::npos) << told.format();

  const auto staircase = control::load_sequence(folder + "sequences/pressure_staircase.yaml", none);
  document::Problems silent;
  compare_grips(*staircase, *rig, silent);
  EXPECT_EQ(silent.format(), "") << "a sequence without a grip causes no warning";
}

}  // namespace
}  // namespace softgrip::rig::rig_comparison_test
