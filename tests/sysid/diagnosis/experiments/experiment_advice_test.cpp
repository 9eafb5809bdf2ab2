#include "sysid/diagnosis/experiments/experiment_advice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid::experiment_advice_test {
namespace {

bool says(const std::vector<std::string>& advice, std::string_view words) {
  return std::any_of(advice.begin(), advice.end(),
                     [&](const std::string& sentence) { return sentence.find(words) != std::string::npos; });
}

TEST(Advice, ExistsForEveryPairOfCauses) {
  for (const Cause& one : all_causes()) {
    for (const Cause& other : all_causes()) {
      if (one == other) continue;
      const auto advice = advice_for(one.id, other.id, {});
      EXPECT_FALSE(advice.empty()) << one.id << ", " << other.id;
      EXPECT_EQ(advice.size(), advice_for(other.id, one.id, {}).size()) << one.id << ", " << other.id;
      for (const std::string& sentence : advice) EXPECT_FALSE(sentence.empty());
    }
  }
  EXPECT_FALSE(advice_for("none", all_causes().front().id, {}).empty());
}

TEST(Advice, IsEmptyForSeparableCausesUnlessPressureIsMissing) {
  EXPECT_TRUE(advice_for("backlash", "contact", {.separable = true}).empty());
  // If the log has no pressure column, the advice must be to record the pressure, because this is simpler
  // than an experiment.
  EXPECT_TRUE(says(advice_for("valve_lag", "sensor_lag", {.separable = true}), "Record pressure_kpa"));
  EXPECT_TRUE(advice_for("valve_lag", "sensor_lag", {.pressure_recorded = true, .separable = true}).empty());
}

TEST(Advice, StatesThatAVacuumPermitsNoExperiment) {
  const auto usual = advice_for("inertia", "rate_dependent_hysteresis", {});
  EXPECT_TRUE(says(usual, "a higher pressure")) << usual.front();
  const auto vacuum = advice_for("inertia", "rate_dependent_hysteresis", {.may_be_pressurised = false});
  EXPECT_TRUE(says(vacuum, "the logs contain no pressure above 0")) << vacuum.front();
  EXPECT_FALSE(says(vacuum, "a higher pressure"));
}

TEST(Advice, DependsOnThePairOfCausesAndTheData) {
  EXPECT_TRUE(says(advice_for("stiffening", "contact", {}), "Change the load"));
  EXPECT_TRUE(
      says(advice_for("stiffening", "contact", {.gauge_made = true}), "The gauge check was not conclusive"));
  EXPECT_TRUE(says(advice_for("slow_creep", "ageing", {}), "vented for an hour"));
  EXPECT_TRUE(says(advice_for("stress_softening", "ageing", {}), "a different temperature"));
  EXPECT_FALSE(says(advice_for("stress_softening", "ageing", {.temperature_varies = true}),
                    "a different temperature"));
  EXPECT_TRUE(
      says(advice_for("thermal_gain", "contact", {.temperature_varies = true}), "a different temperature"));
  EXPECT_TRUE(says(advice_for("inertia", "contact", {}), "No waveform"));
}

}  // namespace
}  // namespace softgrip::sysid::experiment_advice_test
