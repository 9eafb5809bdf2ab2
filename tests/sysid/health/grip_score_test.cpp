#include "sysid/health/grip_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "model/named.h"
#include "tests/sysid/health/grip_fixture.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::health::grip_score_test {
namespace {

using sysid::HealthNumber;

GripScore scored(const GripWorld& world) {
  return score_of(grip_of(world), 0, score_base(sysid::loaded("bench_twin"), 60));
}

TEST(GripScore, HealthyGripMatchesTheBaseline) {
  const ScoreBase base = score_base(sysid::loaded("bench_twin"), 60);
  EXPECT_NEAR(base.full_mm, 25, 10);
  const GripScore score = scored({});
  EXPECT_NEAR(score[HealthNumber::gain], base.full_mm, 0.01 * base.full_mm);
  EXPECT_NEAR(score[HealthNumber::zero], 0, 0.02);
  EXPECT_NEAR(score[HealthNumber::lag], 0, 0.003);
  EXPECT_NEAR(score[HealthNumber::creep], 0, 0.02);
  EXPECT_NEAR(score[HealthNumber::loop_width], 0, 0.1);
  EXPECT_NEAR(score[HealthNumber::pressure_loss], 0, 0.05);
  EXPECT_NEAR(score[HealthNumber::leak], 0, 0.05);
  EXPECT_NEAR(score[HealthNumber::contact], 12.15, 0.05);  // at the detection of the contact, the object has
                                                           // yielded by 0.15 mm
  EXPECT_GT(score[HealthNumber::time_to_grip], 2.9);
}

struct Changed {
  const char* what;
  GripWorld world;
  HealthNumber number;
  double by;
  double tolerance;
};

class ScoredChange : public ::testing::TestWithParam<Changed> {};

TEST_P(ScoredChange, AppearsInTheMatchingIndicatorWithTheTrueSize) {
  const Changed& changed = GetParam();
  const GripScore before = scored({}), after = scored(changed.world);
  EXPECT_NEAR(after[changed.number] - before[changed.number], changed.by, changed.tolerance);
}

TEST_P(ScoredChange, LeavesUnrelatedIndicatorsUnchanged) {
  const Changed& changed = GetParam();
  const ScoreBase base = score_base(sysid::loaded("bench_twin"), 60);
  const GripScore before = scored({}), after = scored(changed.world);
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    const auto number = static_cast<HealthNumber>(i);
    if (number == changed.number || number == HealthNumber::contact) continue;
    if (number == HealthNumber::loop_width && changed.number == HealthNumber::lag) continue;
    EXPECT_NEAR(after[number], before[number], 6 * least_difference(number, base))
        << changed.what << " in " << sysid::info_of(number).id;
  }
}

const double full_mm = score_base(sysid::loaded("bench_twin"), 60).full_mm;

INSTANTIATE_TEST_SUITE_P(
    OfAGrip, ScoredChange,
    testing::Values(Changed{"gain", {.gain = 0.95}, HealthNumber::gain, -0.05 * full_mm, 0.006 * full_mm},
                    Changed{"zero", {.zero_mm = 0.4}, HealthNumber::zero, 0.4, 0.02},
                    Changed{"lag", {.lag_s = 0.05}, HealthNumber::lag, 0.05, 0.005},
                    Changed{"creep", {.extra_creep_mm = 0.2}, HealthNumber::creep, 0.2, 0.06},
                    Changed{"loop", {.loop_mm = 0.3}, HealthNumber::loop_width, 0.3, 0.05},
                    Changed{"loss", {.loss_kpa = 2}, HealthNumber::pressure_loss, 2, 0.05},
                    Changed{"contact", {.object_mm = 11}, HealthNumber::contact, -1, 0.05}),
    [](const auto& test) { return test.param.what; });

/// Returns the model of a finger whose displacement is `factor` times that of the finger of `model`.
model::Model scaled(const model::Model& model, double factor) {
  std::vector<double> values = model::flat_values(model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string_view unit = model::parameter_spec(model, i).unit;
    if (unit.starts_with("mm")) values[i] *= factor;
    if (unit.ends_with("/mm")) values[i] /= factor;
  }
  return model::with_values(model, values);
}

TEST(GripScore, DisplacementIndicatorsOfASmallFingerScaleWithItsDisplacement) {
  constexpr double factor = 0.08;
  const model::Model twin = sysid::loaded("bench_twin");
  const ScoreBase large = score_base(twin, 60), small = score_base(scaled(twin, factor), 60);
  ASSERT_NEAR(small.full_mm, factor * large.full_mm, 1e-3 * large.full_mm);
  Recording recording = grip_of({.gain = 0.9, .loop_mm = 0.3});
  const GripScore of_large = score_of(recording, 0, large);
  for (double& reading : recording.channels[0].displacement_mm) reading *= factor;
  const GripScore of_small = score_of(recording, 0, small);
  for (const auto number :
       {HealthNumber::gain, HealthNumber::zero, HealthNumber::creep, HealthNumber::loop_width}) {
    ASSERT_TRUE(std::isfinite(of_large[number])) << sysid::info_of(number).id;
    EXPECT_NEAR(of_small[number], factor * of_large[number], 1e-4 * small.full_mm)
        << sysid::info_of(number).id;
  }
  EXPECT_NEAR(of_small[HealthNumber::lag], of_large[HealthNumber::lag], 1e-4);
}

TEST(GripScore, LeakIndicatorEqualsTheLeakRateDuringHolding) {
  const GripScore before = scored({}), after = scored({.leak_kpa_per_s = 0.5});
  EXPECT_NEAR(after[HealthNumber::leak] - before[HealthNumber::leak], 0.5, 0.03);
  EXPECT_NEAR(after[HealthNumber::gain], before[HealthNumber::gain], 1e-9);
}

TEST(GripScore, IndicatorsWithoutDataAreAbsent) {
  const GripScore blind = scored({.measures_pressure = false});
  EXPECT_TRUE(std::isnan(blind[HealthNumber::pressure_loss]));
  EXPECT_TRUE(std::isnan(blind[HealthNumber::leak]));
  const GripScore empty = scored({.object_mm = std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(std::isnan(empty[HealthNumber::contact]));
  EXPECT_TRUE(std::isnan(empty[HealthNumber::time_to_grip]));
  EXPECT_TRUE(std::isnan(empty[HealthNumber::leak]));
  EXPECT_TRUE(std::isfinite(empty[HealthNumber::gain]));
  // The finger moves by 0.5 mm, which is not enough to estimate the gain.
  const GripScore near = scored({.object_mm = 0.5});
  EXPECT_TRUE(std::isnan(near[HealthNumber::gain]));
  EXPECT_TRUE(std::isnan(near[HealthNumber::lag]));
  EXPECT_TRUE(std::isfinite(near[HealthNumber::contact]));
}

TEST(GripScore, MissingReadingsGiveNoDisplacementIndicators) {
  Recording recording = grip_of({.measures_pressure = false});
  for (double& reading : recording.channels[0].displacement_mm) reading = NAN;
  const GripScore score = score_of(recording, 0, score_base(sysid::loaded("bench_twin"), 60));
  for (const auto number : {HealthNumber::gain, HealthNumber::zero, HealthNumber::lag, HealthNumber::creep,
                            HealthNumber::loop_width, HealthNumber::contact})
    EXPECT_TRUE(std::isnan(score[number])) << sysid::info_of(number).id;
}

TEST(GripParts, AMissingReadingAtTheContactKeepsTheFreeMotion) {
  Recording grip = grip_of({});
  const std::vector<double> predicted(grip.channels[0].size(), 0.0);
  const GripParts whole = parts_of(grip, 0, predicted, 60, 20);
  std::size_t missing = 0;
  for (const RecordedEvent& event : grip.events) {
    if (event.kind != "contact") continue;
    std::size_t i = 0;
    while (grip.channels[0].time_s[i] < event.time_s) ++i;
    grip.channels[0].displacement_mm[i] = NAN;
    ++missing;
  }
  ASSERT_EQ(missing, 1U);
  const GripParts parts = parts_of(grip, 0, predicted, 60, 20);
  const auto free_samples = [](const GripParts& all) {
    return static_cast<double>(std::count(all.at.begin(), all.at.end(), Part::free));
  };
  EXPECT_GT(free_samples(whole), 100);
  EXPECT_NEAR(free_samples(parts), free_samples(whole), 3);
}

TEST(GripParts, HeldLastsFromHoldingToRelease) {
  const Recording grip = grip_of({});
  const std::vector<double> predicted(grip.channels[0].size(), 0.0);
  const GripParts parts = parts_of(grip, 0, predicted, 60, 20);
  double held_from = NAN, held_to = NAN;
  for (std::size_t i = 0; i < parts.at.size(); ++i) {
    if (parts.at[i] != Part::held) continue;
    if (std::isnan(held_from)) held_from = grip.channels[0].time_s[i];
    held_to = grip.channels[0].time_s[i];
  }
  EXPECT_NEAR(held_from, parts.holding_s, 0.011);
  EXPECT_NEAR(held_to, 7.5, 0.03);
  EXPECT_EQ(parts.at.front(), Part::rest);
}

TEST(GripParts, SamplesAfterAFaultBelongToNoPart) {
  Recording grip = grip_of({});
  grip.events.insert(grip.events.begin() + 1, {1.0, "fault_latched", "left", "F201", ""});
  const std::vector<double> predicted(grip.channels[0].size(), 0.0);
  const GripParts parts = parts_of(grip, 0, predicted, 60, 20);
  for (std::size_t i = 0; i < parts.at.size(); ++i) {
    if (grip.channels[0].time_s[i] > 1.01) {
      ASSERT_EQ(parts.at[i], Part::neither);
    }
  }
}

TEST(GripParts, StepWithHoldingButNoContactIsNotFreeMotion) {
  Recording grip = grip_of({});
  std::erase_if(grip.events, [](const RecordedEvent& event) { return event.kind == "contact"; });
  grip.events.insert(grip.events.begin() + 1, {2.0, "step_started", "", "1", ""});
  const std::vector<double> predicted(grip.channels[0].size(), 0.0);
  const GripParts parts = parts_of(grip, 0, predicted, 60, 20);
  EXPECT_EQ(parts.at[150], Part::free);
  EXPECT_EQ(parts.at[250], Part::neither);
}

}  // namespace
}  // namespace softgrip::sysid::health::grip_score_test
