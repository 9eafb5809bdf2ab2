#include "control/sequences/sequence_plans.h"

#include <gtest/gtest.h>

#include <string>

#include "control/sequences/sequence_file.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control::fit_sequence_test {
namespace {

Sequence sequence_of(const std::string& steps) {
  document::Problems problems;
  const auto document = document::parse("seq.yaml", "name: x\nsteps:\n" + steps, problems);
  const auto sequence = read_sequence(document, problems);
  EXPECT_TRUE(sequence) << problems.format();
  return sequence ? *sequence : Sequence{};
}

TEST(FitSequence, GivesEachStepItsChannels) {
  const RigSettings settings = two_finger_settings();
  document::Problems problems;
  const Sequence sequence = sequence_of(
      "  - move: {channels: [left], pressure_kpa: 10, duration_s: 1}\n"
      "  - move: {pressure_kpa: 20, duration_s: 1}\n");
  PreparedSequence fitted = fit_to_rig(sequence, settings, problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  ASSERT_EQ(fitted.steps.size(), 2U);
  EXPECT_EQ(fitted.steps[0].channels, 1U);
  EXPECT_EQ(fitted.steps[1].channels, 3U);
  plan_motion(sequence, settings, fitted, problems, {});
  EXPECT_TRUE(problems.empty()) << problems.format();
}

TEST(FitSequence, ReportsAStepBeyondTheLimitsOfTheRig) {
  const RigSettings settings = two_finger_settings();
  document::Problems problems;
  const Sequence sequence = sequence_of("  - move: {pressure_kpa: 900, duration_s: 1}\n");
  static_cast<void>(fit_to_rig(sequence, settings, problems));
  EXPECT_EQ(problems.size(), 2U) << problems.format();
}

}  // namespace
}  // namespace softgrip::control::fit_sequence_test
