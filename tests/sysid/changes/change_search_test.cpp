#include "sysid/changes/change_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/blocks/bouc_wen.h"
#include "model/named.h"
#include "sysid/changes/change_size.h"
#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_search_test {
namespace {

class ChangeSearch : public test::PressureBase {};

TEST_F(ChangeSearch, DelayEffectRanksFirstForADelayedPressure) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  const std::vector<ScoredEffect> ranked = ranked_effects(later, effects, {}, {}, 1);
  ASSERT_FALSE(ranked.empty());
  EXPECT_EQ(ranked.front().fit.fitted.effect.id, "transport_delay");
  const ChangeSize size = size_of(later, ranked.front().fit.fitted, 0);
  EXPECT_EQ(size.unit, "s");
  EXPECT_NEAR(size.value, 0.06, 0.01);
  EXPECT_TRUE(is_better(compare(paired_losses(later, later.white({}), ranked.front().fit.white), 0, 1)));
}

TEST_F(ChangeSearch, ACauseThatWasFoundIsNotRankedAgain) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  const std::vector<ScoredEffect> first = ranked_effects(later, effects, {}, {}, 1);
  const std::vector<ScoredEffect> second = ranked_effects(later, effects, {first.front().fit.fitted}, {}, 1);
  EXPECT_EQ(second.size(), first.size() - 1);
  for (const ScoredEffect& each : second) EXPECT_NE(each.fit.fitted.effect.id, "transport_delay");
}

TEST_F(ChangeSearch, ErrorReductionInHealthyRunsLowersTheRank) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  NullGains gains;
  for (const Effect& effect : effects) gains[effect.id] = effect.id == "transport_delay" ? 1e9 : 0;
  const std::vector<ScoredEffect> ranked =
      ranked_effects(later, effects, {}, Tolerance(std::vector{gains}, 1), 1);
  EXPECT_EQ(ranked.back().fit.fitted.effect.id, "transport_delay");
}

TEST_F(ChangeSearch, SymmetricFillingLagIsAttributedToTheValve) {
  const LaterReadings later = readings({.valve_lag_s = 0.08});
  std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  std::erase_if(effects, [](const Effect& e) { return e.id != "valve_lag" && e.id != "blocked_line"; });
  std::reverse(effects.begin(), effects.end());
  // Error reductions that each of the two causes reaches in healthy runs.
  const Tolerance tolerance({{{"valve_lag", 0.05}, {"blocked_line", 0.05}}}, 2);
  std::vector<ScoredEffect> ranked = ranked_effects(later, effects, {}, tolerance, 1);
  ASSERT_EQ(ranked.size(), 2U);
  put_fewest_numbers_first(ranked, ties_in(later, 1));
  EXPECT_NEAR(ranked[1].gain, ranked[0].gain, 0.01 * ranked[0].gain);
  EXPECT_EQ(ranked[0].fit.fitted.effect.id, "valve_lag");
}

TEST_F(ChangeSearch, TiedEffectWithFewestParametersRanksFirst) {
  const LaterReadings later = readings({.delay_s = 0.02});
  std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  std::erase_if(effects, [](const Effect& e) { return e.id != "transport_delay"; });
  // The effect `dearer` is a delay with an additional parameter that has no effect on the prediction. The
  // error reduction by `dearer` is slightly larger than the reduction by the delay.
  Effect dearer = effects.front();
  dearer.id = "dearer";
  dearer.numbers.push_back({"idle", "", 1, 0, 1});
  dearer.nothing.push_back(0);
  for (std::vector<double>& start : dearer.starts) start.push_back(0.5);
  dearer.apply = [delay = effects.front().apply](Extension& e, const std::vector<double>& n) {
    delay(e, {n[0]});
    e.gain *= 1.0002;
  };
  effects.insert(effects.begin(), dearer);
  std::vector<ScoredEffect> ranked =
      ranked_effects(later, effects, {}, Tolerance({{{"transport_delay", 0.02}, {"dearer", 0}}}, 1), 1);
  ASSERT_EQ(ranked.size(), 2U);
  put_fewest_numbers_first(ranked, ties_in(later, 1));
  EXPECT_LT(ranked[0].gain - ranked[0].usual, ranked[1].gain - ranked[1].usual);
  EXPECT_EQ(ranked[0].fit.fitted.effect.id, "transport_delay");
}

TEST(Effects, ParametersHaveTheDeprecatedNameOfTheBlockParameter) {
  Base base;
  base.model = model::with_block({}, model::default_block(model::block_type<model::BoucWen>()));
  base.drive = Drive::command;
  std::size_t renamed = 0;
  for (const Effect& effect : effects_for(base, make_records(test::logs_of({}, 1), {}), {}, false)) {
    for (const EffectNumber& number : effect.numbers) {
      if (number.name != "saturation_per_kpa" && number.name != "saturation") continue;
      EXPECT_EQ(number.formerly, number.name == "saturation" ? "levelling" : "levelling_per_kpa");
      ++renamed;
    }
  }
  EXPECT_GT(renamed, 0U);
}

/// Returns an effect with the given error reduction and the given numbers of parameters.
ScoredEffect scored(const char* id, double gain, std::size_t numbers, std::size_t nuisance = 0) {
  ScoredEffect scored;
  scored.gain = gain;
  scored.fit.fitted.effect.id = id;
  scored.fit.fitted.effect.numbers.resize(numbers);
  scored.fit.fitted.effect.nuisance_numbers = nuisance;
  return scored;
}

bool always(const ScoredEffect&, const ScoredEffect&) {
  return true;
}
bool never(const ScoredEffect&, const ScoredEffect&) {
  return false;
}

TEST(FewestNumbersFirst, NuisanceParameterCountsLessThanARealParameter) {
  std::vector<ScoredEffect> ranked{scored("two", 10.01, 2), scored("one_and_slack", 10, 2, 1)};
  put_fewest_numbers_first(ranked, always);
  EXPECT_EQ(ranked[0].fit.fitted.effect.id, "one_and_slack");
  ranked.push_back(scored("one", 9.99, 1));
  put_fewest_numbers_first(ranked, always);
  EXPECT_EQ(ranked[0].fit.fitted.effect.id, "one");
}

TEST(FewestNumbersFirst, BestDistinguishableEffectStaysFirst) {
  std::vector<ScoredEffect> ranked{scored("two", 10, 2), scored("one", 9.9, 1)};
  put_fewest_numbers_first(ranked, never);
  EXPECT_EQ(ranked[0].fit.fitted.effect.id, "two");
}

TEST(FewestNumbersFirst, IdealEffectRanksBehindATiedEffect) {
  std::vector<ScoredEffect> ranked{scored("dead time", 10, 1), scored("lag", 9.8, 1)};
  ranked[0].fit.fitted.effect.is_ideal = true;
  put_fewest_numbers_first(ranked, always);
  EXPECT_EQ(ranked[0].fit.fitted.effect.id, "lag");
}

TEST_F(ChangeSearch, DeclaredIndistinguishableEffectsAlwaysTie) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  std::vector<ScoredEffect> ranked = ranked_effects(later, effects, {}, {}, 1);
  const Ties ties = ties_in(later, 1);
  EXPECT_FALSE(ties(ranked.front(), ranked.back()));
  ranked.front().fit.fitted.effect.indistinguishable = ranked.back().fit.fitted.effect.id;
  EXPECT_TRUE(ties(ranked.front(), ranked.back()));
}

TEST_F(ChangeSearch, PlainRmsDecreasesOnlyForTheTrueDelay) {
  const LaterReadings later = readings({.delay_s = 0.06});
  std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  std::erase_if(effects, [](const Effect& e) { return e.id != "transport_delay"; });
  ASSERT_EQ(effects.size(), 1U);
  const double without = later.plain_rms({});
  EXPECT_LT(later.plain_rms({{effects[0], {0.06}}}), 0.5 * without);
  EXPECT_GT(later.plain_rms({{effects[0], {0.3}}}), 2 * without);
  EXPECT_NEAR(later.plain_rms({{effects[0], {0.0}}}), without, 1e-9);
}

TEST_F(ChangeSearch, PlainRmsIgnoresAZeroOffset) {
  const LaterReadings later = readings({});
  Binned moved = later.left();
  for (double& v : moved[0]) v += 3;
  const LaterReadings other(base_, later.records(), moved);
  EXPECT_NEAR(other.plain_rms({}), later.plain_rms({}), 1e-9);
}

TEST_F(ChangeSearch, AtFullPressureReturnsAConstantAdditionUnchanged) {
  const LaterReadings later = readings({});
  Binned added = later.left();
  for (auto& series : added) std::fill(series.begin(), series.end(), -0.7);
  EXPECT_NEAR(at_full_pressure(later, added), -0.7, 1e-9);
}

}  // namespace
}  // namespace softgrip::sysid::change_search_test
