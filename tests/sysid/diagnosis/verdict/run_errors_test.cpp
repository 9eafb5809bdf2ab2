#include "sysid/diagnosis/verdict/run_errors.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::run_errors_test {
namespace {

BlockLosses losses(const Division& division, double first_mm2, double other_mm2) {
  BlockLosses each;
  for (const Block& block : division.blocks) each.push_back(block.fold == 0 ? first_mm2 : other_mm2);
  return each;
}

TEST(RunErrors, AreTheErrorsOfEachRun) {
  const std::vector<Record> records = known_campaign(2);
  const Division by_unit = divide_by_unit(records);
  const std::vector<RunError> runs =
      run_errors(records, by_unit, losses(by_unit, 4, 9), losses(by_unit, 1, 4), losses(by_unit, 0.25, 1));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].run, "log_1");
  EXPECT_EQ(runs[1].run, "log_2");
  EXPECT_DOUBLE_EQ(runs[0].given, 2);
  EXPECT_DOUBLE_EQ(runs[1].given, 3);
  EXPECT_DOUBLE_EQ(runs[0].recalibrated, 1);
  EXPECT_DOUBLE_EQ(runs[1].recalibrated, 2);
  EXPECT_DOUBLE_EQ(runs[0].extended, 0.5);
  EXPECT_DOUBLE_EQ(runs[1].extended, 1);
}

TEST(RunErrors, AreThoseOfBothHalvesOfASingleRun) {
  const std::vector<Record> records = known_campaign(1);
  const Division by_unit = divide_by_unit(records);
  const BlockLosses given = losses(by_unit, 4, 9);
  const std::vector<RunError> halves = run_errors(records, by_unit, given, given, given);
  ASSERT_EQ(halves.size(), 2U);
  EXPECT_EQ(halves[0].run, "first half");
  EXPECT_EQ(halves[1].run, "second half");
  EXPECT_DOUBLE_EQ(halves[0].given, 2);
  EXPECT_DOUBLE_EQ(halves[1].given, 3);
}

}  // namespace
}  // namespace softgrip::sysid::run_errors_test
