#include "sysid/changes/chance.h"

#include <gtest/gtest.h>

#include "sysid/changes/causes_of_the_air.h"
#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::chance_test {
namespace {

ScoredEffect scored(double gain, double chance) {
  ScoredEffect scored;
  scored.gain = gain;
  scored.chance = chance;
  return scored;
}

Base with_bins_of_a_second(Judged judged) {
  Base base;
  base.bin_s = 1;
  base.judged = judged;
  return base;
}

TEST(Chance, WhatShowsWhereTheDriveTurnsMustTakeMore) {
  const Base finger = with_bins_of_a_second(Judged::displacement);
  ScoredEffect effect = scored(0.5, 0);
  EXPECT_TRUE(stands_out(effect, finger));
  effect.fit.fitted.effect.where_bases_miss = true;
  EXPECT_FALSE(stands_out(effect, finger));
  effect.gain = 1;
  EXPECT_TRUE(stands_out(effect, finger));
  EXPECT_FALSE(stands_out(effect, with_bins_of_a_second(Judged::pressure)));
  effect.fit.fitted.effect.free_form = true;
  EXPECT_FALSE(stands_out(effect, finger));
}

TEST(Chance, WhatItTakesOfHealthyLogsCountsTwice) {
  const Base finger = with_bins_of_a_second(Judged::displacement);
  EXPECT_TRUE(stands_out(scored(2.5, 1), finger));
  EXPECT_FALSE(stands_out(scored(2.3, 1), finger));
}

class ChanceOfHealthy : public test::PressureBase {};

TEST_F(ChanceOfHealthy, OfEveryCauseIsAShareOfTheLargestAtLeast) {
  // As if the finger's valve answered later on one of the healthy days.
  LaterReadings late = readings({.delay_s = 0.06});
  std::vector<Effect> effects = effects_for(base_, late.records(), {}, true);
  for (Effect& effect : effects) effect.where_bases_miss = effect.id == leak.id;
  const Chance chance = chance_of(late, effects, 1);
  const double largest = chance.at("transport_delay");
  EXPECT_GT(largest, 1);
  EXPECT_NEAR(chance.at("pressure_saturation"), 0.15 * largest, 1e-9);
  EXPECT_NEAR(chance.at("leak"), 0.35 * largest, 1e-9);
}

}  // namespace
}  // namespace softgrip::sysid::chance_test
