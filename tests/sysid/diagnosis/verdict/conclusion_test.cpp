#include "sysid/diagnosis/verdict/conclusion.h"

#include <vector>

#include <gtest/gtest.h>

namespace softgrip::sysid::conclusion_test {
namespace {

TEST(Conclusion, WithoutACauseMayLeaveAPartOfTheNoise) {
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

}  // namespace
}  // namespace softgrip::sysid::conclusion_test
