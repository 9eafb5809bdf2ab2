#include "control/elements/grip_result.h"

#include <gtest/gtest.h>

#include <vector>

namespace softgrip::control::grip_result_test {
namespace {

using enum control::GripResult;

TEST(OverallResult, IsTheWorstFailureElseTheResultThatAllFingersShare) {
  const auto of = [](const std::vector<control::GripResult>& results) {
    return overall_result(results, ~0U);
  };
  EXPECT_EQ(of({holding, holding}), holding);
  EXPECT_EQ(of({released, released, released}), released);
  EXPECT_EQ(of({holding, control::GripResult::none}), control::GripResult::none);
  EXPECT_EQ(of({holding, released}), control::GripResult::none);
  EXPECT_EQ(of({holding, no_part}), no_part);
  EXPECT_EQ(of({no_part, part_lost}), part_lost);
  EXPECT_EQ(of({part_lost, error, holding}), error);
}

TEST(OverallResult, FingersThatDoNotTakePartDoNotCount) {
  const std::vector<control::GripResult> results{holding, no_part, holding};
  EXPECT_EQ(overall_result(results, 0b101), holding);
  EXPECT_EQ(overall_result(results, 0b010), no_part);
  EXPECT_EQ(overall_result(results, 0), control::GripResult::none);
}

}  // namespace
}  // namespace softgrip::control::grip_result_test
