#include "sysid/diagnosis/verdict/conclusion.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::conclusion_test {
namespace {

TEST(Conclusion, OutliersPermitAnUncorrelatedUnexplainedError) {
  const std::vector<Log> logs;
  const model::Model given;
  const DiagnosisOptions options;
  const SearchData data;
  Diagnosis diagnosis;
  diagnosis.noise_mm = 0.1;
  const Conclusion conclusion(logs, given, options, data, diagnosis);
  Selection selection;
  selection.left.excess_mm = 0.05;
  EXPECT_FALSE(conclusion.leaves_too_much(selection)) << "no unexplained error is present";
  selection.left.present = true;
  EXPECT_TRUE(conclusion.leaves_too_much(selection));
  EXPECT_FALSE(conclusion.left_by_outliers(selection.left));
  diagnosis.outliers.present = true;
  EXPECT_TRUE(conclusion.left_by_outliers(selection.left));
  EXPECT_FALSE(conclusion.leaves_too_much(selection)) << "outliers that were not found leave this error";
  selection.left.slow_correlation = 0.5;
  EXPECT_TRUE(conclusion.leaves_too_much(selection)) << "the error is correlated from sample to sample";
}

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

TEST(RunErrors, SingleRunGivesTheErrorsOfBothHalves) {
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
}  // namespace softgrip::sysid::conclusion_test
