#include "sysid/changes/next_steps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/catalogue.h"
#include "sysid/changes/causes_without_block.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid::next_steps_test {
namespace {

TEST(NextSteps, EveryCauseHasTwoNextStepsAndADescription) {
  std::vector<std::string_view> ids;
  for (const CauseWithoutBlock& cause : causes_without_block) ids.push_back(cause.id);
  for (const Cause& cause : all_causes()) {
    // The two causes in this condition are never reported as the cause of a change. hysteresis_shape explains
    // an error of the model, not a change of the finger. pressure_scale is listed only as an alternative to a
    // leak.
    if (cause.id != "hysteresis_shape" && cause.id != "pressure_scale") ids.push_back(cause.id);
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

TEST(NextSteps, SizeParameterExistsInABlockOfTheCause) {
  std::size_t numbers = 0;
  for (const Cause& cause : all_causes()) {
    const SizedBy size = sized_by(cause.id);
    // the size of a leak has no block parameter, because a separate search finds the leak
    if (size.of != SizedBy::Of::number || cause.id == leak.id) continue;
    ++numbers;
    EXPECT_FALSE(size.unit.empty()) << cause.id;
    const bool known = std::any_of(cause.forms.begin(), cause.forms.end(), [&](const CauseForm& form) {
      const model::BlockDescriptor& descriptor = model::catalogue()[form.type];
      for (std::size_t i = 0; i < descriptor.parameters.size(); ++i) {
        if (descriptor.name(i) == size.number) return true;
      }
      return false;
    });
    EXPECT_TRUE(known) << cause.id << " has no " << size.number;
  }
  EXPECT_GE(numbers, 9U);
  EXPECT_EQ(sized_by(blocked_line.id).number, "filling_s");
  EXPECT_EQ(blocked_line.appears, Appears::moving);
}

}  // namespace
}  // namespace softgrip::sysid::next_steps_test
