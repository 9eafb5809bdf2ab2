#include "sysid/changes/next_steps.h"

#include <gtest/gtest.h>

#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid::next_steps_test {
namespace {

TEST(NextSteps, EveryCauseHasTwoThingsToDoAndPlainWords) {
  std::vector<std::string_view> ids{"leak", "blocked_line"};
  for (const Cause& cause : all_causes()) {
    if (cause.id != "hysteresis_shape") ids.push_back(cause.id);  // of a base, not of a change
  }
  for (const std::string_view id : ids) {
    const auto steps = next_steps(id);
    EXPECT_GT(steps[0].size(), 20U) << id;
    EXPECT_GT(steps[1].size(), 20U) << id;
    EXPECT_NE(steps[0], steps[1]) << id;
    EXPECT_FALSE(plain_words(id).empty()) << id;
  }
  EXPECT_TRUE(plain_words("no_cause").empty());
}

}  // namespace
}  // namespace softgrip::sysid::next_steps_test
