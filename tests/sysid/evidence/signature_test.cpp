#include "sysid/evidence/signature.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace softgrip::sysid::signature_test {
namespace {

/// Returns the operating points of a grip that consists of a rest, a rise, a hold at 50 kPa, a fall and a
/// rest.
std::vector<OperatingPoint> grip() {
  return {{0, 0, 0}, {1, 0, 0}, {20, 30, 4}, {40, 30, 8}, {50, 0, 10}, {50, 0, 10}, {20, 30, 5}, {0, 0, 1}};
}

TEST(Signature, ConditionsSelectTheirPhasesOfAGrip) {
  EXPECT_EQ(required_at(Appears::at_rest, grip()),
            (std::vector<bool>{true, true, false, false, false, false, false, true}));
  EXPECT_EQ(required_at(Appears::held, grip()),
            (std::vector<bool>{false, false, false, false, true, true, false, false}));
  EXPECT_EQ(required_at(Appears::moving, grip()),
            (std::vector<bool>{false, false, true, true, false, false, true, false}));
  EXPECT_EQ(required_at(Appears::displaced, grip()),
            (std::vector<bool>{false, false, false, true, true, true, false, false}));
  EXPECT_EQ(required_at(Appears::anywhere, grip()), std::vector<bool>(8, true));
}

TEST(Signature, TheScaleAndTheOffsetOfThePressureDoNotMatter) {
  std::vector<OperatingPoint> other = grip();
  for (OperatingPoint& at : other) at = {100 + 0.001 * at.pressure_kpa, 7 * at.rate_kpa_per_s, at.motion};
  for (const Appears appears : {Appears::at_rest, Appears::held, Appears::moving, Appears::displaced})
    EXPECT_EQ(required_at(appears, other), required_at(appears, grip()));
}

TEST(Signature, AVacuumActuatorRestsAtItsHighestPressure) {
  std::vector<OperatingPoint> vacuum = grip();
  for (OperatingPoint& at : vacuum) at.pressure_kpa = -at.pressure_kpa;
  for (const Appears appears : {Appears::at_rest, Appears::held, Appears::moving, Appears::displaced})
    EXPECT_EQ(required_at(appears, vacuum), required_at(appears, grip()));
}

TEST(Signature, NegativeDisplacementsAreLargeAtTheLowestDisplacement) {
  std::vector<OperatingPoint> vacuum = grip();
  for (OperatingPoint& at : vacuum) at = {-at.pressure_kpa, at.rate_kpa_per_s, -2 * at.motion};
  EXPECT_EQ(required_at(Appears::displaced, vacuum),
            (std::vector<bool>{false, false, false, true, true, true, false, false}));
}

TEST(Signature, TheOffsetOfTheDisplacementDoesNotMatter) {
  for (const double offset_mm : {-8.0, -3.0, 100.0}) {
    std::vector<OperatingPoint> shifted = grip();
    for (OperatingPoint& at : shifted) at.motion += offset_mm;
    EXPECT_EQ(required_at(Appears::displaced, shifted), required_at(Appears::displaced, grip())) << offset_mm;
  }
}

TEST(Signature, RunWithoutRestHasNoSampleAtRest) {
  const std::vector<OperatingPoint> sine{{0, 30, 0}, {30, 30, 5}, {60, 30, 10}, {30, 30, 5}, {0, 30, 0}};
  const std::vector<bool> at_rest = required_at(Appears::at_rest, sine);
  EXPECT_EQ(std::count(at_rest.begin(), at_rest.end(), true), 0);
}

TEST(Signature, ConditionIsMetAtFiveOperatingPoints) {
  std::vector<bool> required{true, false, true, true, false, true};
  EXPECT_FALSE(is_met(required));
  required.push_back(true);
  EXPECT_TRUE(is_met(required));
}

TEST(Signature, EveryConditionHasARecordingInstruction) {
  for (const Appears appears :
       {Appears::anywhere, Appears::at_rest, Appears::held, Appears::moving, Appears::displaced})
    EXPECT_EQ(recording_for(appears).substr(0, 7), "record ");
  const auto contains = [](Appears appears, std::string_view words) {
    return recording_for(appears).find(words) != std::string_view::npos;
  };
  EXPECT_TRUE(contains(Appears::at_rest, "rest without pressure"));
  EXPECT_TRUE(contains(Appears::held, "holds a pressure"));
  EXPECT_TRUE(contains(Appears::moving, "rates"));
  EXPECT_TRUE(contains(Appears::displaced, "highest pressure"));
}

TEST(Rates, DecayFromThePeakWithATimeConstantOfHalfASecond) {
  Record record;
  record.time_s = {0, 1, 2, 2.5};
  record.duration_s = {0, 1, 1, 0.5};
  record.drive_kpa = {0, 3, 3, 3};
  const std::vector<double> rates = rates_of(record);
  ASSERT_EQ(rates.size(), 4U);
  EXPECT_EQ(rates[0], 0);
  EXPECT_EQ(rates[1], 3);
  EXPECT_NEAR(rates[2], 3 * std::exp(-2.0), 1e-12);
  EXPECT_NEAR(rates[3], 3 * std::exp(-3.0), 1e-12);
}

}  // namespace
}  // namespace softgrip::sysid::signature_test
