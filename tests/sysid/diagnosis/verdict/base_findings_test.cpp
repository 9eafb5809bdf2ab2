#include "sysid/diagnosis/verdict/base_findings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"
#include "model/blocks/backlash.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/backlash.h"
#include "sysid/diagnosis/causes/sensor_lag.h"
#include "sysid/diagnosis/causes/transport_delay.h"
#include "sysid/diagnosis/causes/valve_lag.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/slack.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::base_findings_test {
namespace {

using model::SignalName;

constexpr double noise_mm = 0.03;

/// Returns the model bench_twin without its valve blocks.
model::Model published() {
  return model::only(loaded("bench_twin"),
                     [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
}

/// Returns a finger that consists of play operators. No Bouc-Wen element can fit its hysteresis loops.
model::Model plays() {
  model::Model m = model::without_block(published(), model::block_type<model::BoucWen>());
  return model::with_block(std::move(m), {model::block_type<model::PrandtlIshlinskii>(),
                                          {0, 0, 0, 0, 0, 0.1, 1, 0.1, 6, 0.02, 15, 0.08, 25, 0.06}});
}

struct Found {
  SearchData data;
  BaseQuestion question;
  Selection plain;  ///< result of a search on the given model structure; it contains no causes
  std::optional<BaseFindings> base;
};

Found found_in(const model::Model& truth) {
  std::vector<Log> logs;
  for (const SignalName signal : {SignalName::tp1, SignalName::sp2})
    logs.push_back(simulated(truth, signal, 25, noise_mm, 17));
  Found found;
  found.data = make_search_data(make_records(logs, {}), published());
  found.question.noise_mm = noise_mm;
  found.question.division = divide(found.data.records, 8);
  SelectionOptions none;
  none.most_causes = 0;
  found.plain = select_causes(found.data, fit_structure(found.data.records, {}, found.data.given), noise_mm,
                              found.question.division, none);
  found.base = find_base({found.data, found.plain, found.question});
  return found;
}

bool names(const BaseFindings& base, std::string_view id) {
  return std::any_of(base.named.begin(), base.named.end(),
                     [&](const NamedCause& n) { return n.cause.id == id; });
}

bool has_backlash(const BaseFindings& base) {
  const auto shape = std::find_if(base.named.begin(), base.named.end(),
                                  [](const NamedCause& n) { return n.cause.id == "hysteresis_shape"; });
  return shape != base.named.end() &&
         std::any_of(shape->alternatives.begin(), shape->alternatives.end(),
                     [](const Cause& alternative) { return alternative.id == causes::Backlash::id; });
}

/// On the given structure, the error is too large to name a cause. In this case, a slightly smaller loss is
/// sufficient to prefer the alternative structure.
void expect_smaller_loss_suffices_if_the_given_structure_names_no_cause(Found found) {
  Selection plain = found.plain;
  plain.extended_losses = found.base->losses;
  for (double& loss : plain.extended_losses) loss *= 1.05;
  plain.extended.causes = {*find_cause("contact")};
  EXPECT_FALSE(has_lower_loss(*found.base, plain, noise_mm, true));
  EXPECT_TRUE(has_lower_loss(*found.base, plain, noise_mm, false));
  found.base->named.clear();
  EXPECT_FALSE(has_lower_loss(*found.base, plain, noise_mm, false));
}

/// On the given structure, two causes are necessary to explain the data. On the alternative structure, one of
/// them is sufficient, because its hysteresis loops explain the remaining error. The loss of the alternative
/// structure may then be slightly larger.
void expect_fewer_causes_permit_a_larger_loss(Found found) {
  Selection plain = found.plain;
  plain.extended_losses = found.base->losses;
  for (double& loss : plain.extended_losses) loss /= 1.2;
  plain.extended.causes = {*find_cause("contact"), *find_cause("sensor_lag")};
  plain.left.excess_mm = 1.5 * noise_mm;
  EXPECT_FALSE(has_lower_loss(*found.base, plain, noise_mm, true))
      << "the alternative structure contains none of the causes";
  found.base->fit.causes = {*find_cause("contact")};
  EXPECT_TRUE(has_lower_loss(*found.base, plain, noise_mm, true));
  plain.left.excess_mm = 0.5 * noise_mm;
  EXPECT_FALSE(has_lower_loss(*found.base, plain, noise_mm, true))
      << "with the given structure and the two causes, no unexplained error remains";
  plain.left.excess_mm = 1.5 * noise_mm;
  for (double& loss : plain.extended_losses) loss /= 1.6;
  EXPECT_FALSE(has_lower_loss(*found.base, plain, noise_mm, true))
      << "the unexplained error of the alternative structure is much larger than that of the given structure";
}

/// Tests the play operators of the alternative structure again, as if the loss without them were four times
/// as large. In `data`, the readings can differ from those of the search.
BaseFindings named_again(const Found& found, const SearchData& data) {
  BaseFindings base = *found.base;
  base.named.clear();
  base.possible.clear();
  StructureTrial without = base.chosen;
  for (double& loss : without.block_losses_mm2) loss *= 4;
  name_ingredients(base, {{Ingredient::play_operators, without}}, {data, found.plain, found.question});
  return base;
}

/// A random walk of the readings makes the size of every component uncertain. A component is then only a
/// possible cause, although the loss is much larger without it.
void expect_a_component_of_uncertain_size_is_not_named(const Found& found) {
  EXPECT_TRUE(names(named_again(found, found.data), "hysteresis_shape"));
  SearchData moved = found.data;
  for (Record& record : moved.records) {
    double walk_mm = 0;
    for (std::size_t i = 0; i < record.size(); ++i) {
      walk_mm += 2 * normal_at(7, i);
      record.reading_mm[i] += walk_mm;
    }
  }
  const BaseFindings base = named_again(found, moved);
  EXPECT_TRUE(base.named.empty());
  ASSERT_EQ(base.possible.size(), 1U);
  EXPECT_EQ(base.possible[0].cause.id, "hysteresis_shape");
}

/// The search for the alternative structure takes seconds, so one search serves several checks.
TEST(BaseFindings, DifferentLoopShapeIsNamed) {
  const Found found = found_in(plays());
  ASSERT_TRUE(found.base);
  const auto shape = std::find_if(found.base->named.begin(), found.base->named.end(),
                                  [](const NamedCause& n) { return n.cause.id == "hysteresis_shape"; });
  ASSERT_NE(shape, found.base->named.end()) << found.base->description;
  EXPECT_GE(shape->inclusion, 0.95);
  EXPECT_GT(shape->gain_mm2.lower, 0);
  EXPECT_LT(rmse_mm(found.base->losses), 0.5 * rmse_mm(found.plain.base_losses));
  EXPECT_TRUE(has_lower_loss(*found.base, found.plain, noise_mm, true));
  EXPECT_FALSE(has_backlash(*found.base)) << "a set of play operators with an elastic operator moves at once";
  expect_smaller_loss_suffices_if_the_given_structure_names_no_cause(found);
  expect_fewer_causes_permit_a_larger_loss(found);
  expect_a_component_of_uncertain_size_is_not_named(found);
}

/// A set of play operators without an elastic operator does not move at first after a reversal. This looks
/// like a backlash.
TEST(BaseIngredients, BacklashIsAnAlternativeWithoutElasticOperator) {
  const Found slack = found_in(model::with_block(plays(), model::block_of<model::Backlash>({{"gap_mm", 3}})));
  ASSERT_TRUE(slack.base);
  EXPECT_TRUE(has_backlash(*slack.base))
      << slack.base->description << ", elastic share " << elastic_share(slack.base->fit.point.model);
}

/// For slow commands, a delay and a lag have nearly the same effect, so each of them can compensate for the
/// other. If the model contains neither a delay nor a lag, it responds too early.
TEST(BaseFindings, LatencyIsNamedWithDelayAndLagAsAlternatives) {
  const model::Model late =
      model::with_block(plays(), model::block_of<model::ValveLag>({{"time_constant_s", 0.08}}));
  const Found found = found_in(late);
  ASSERT_TRUE(found.base);
  const auto latency =
      std::find_if(found.base->named.begin(), found.base->named.end(), [](const NamedCause& n) {
        return n.cause.id == causes::ValveLag::id || n.cause.id == causes::TransportDelay::id;
      });
  ASSERT_NE(latency, found.base->named.end()) << found.base->description;
  const std::string_view other =
      latency->cause.id == causes::ValveLag::id ? causes::TransportDelay::id : causes::ValveLag::id;
  for (const std::string_view id : {other, causes::SensorLag::id}) {
    EXPECT_TRUE(std::any_of(latency->alternatives.begin(), latency->alternatives.end(),
                            [&](const Cause& alternative) { return alternative.id == id; }))
        << id;
  }
  EXPECT_GE(latency->inclusion, 0.95);
}

/// A cause must be found even if the alternative structure is selected.
TEST(BaseFindings, CauseOnTheAlternativeStructureIsNamed) {
  model::Model finger = plays();
  finger =
      model::with_block(std::move(finger), model::block_of<model::PressureSaturation>({{"limit_kpa", 38}}));
  Found found = found_in(finger);
  ASSERT_TRUE(found.base);
  const double before_mm = rmse_mm(found.base->losses);
  find_causes_upon(*found.base, {found.data, found.plain, found.question}, upon_much_left);
  EXPECT_TRUE(names(*found.base, "pressure_saturation"));
  EXPECT_LT(rmse_mm(found.base->losses), 0.5 * before_mm);
}

TEST(BaseIngredients, DelayLagAndLatencyAreListedOnceEach) {
  const std::vector<Ingredient> away = named_ingredients();
  for (const Ingredient one : {Ingredient::delay, Ingredient::lag, Ingredient::latency})
    EXPECT_EQ(std::count(away.begin(), away.end(), one), 1);
}

TEST(BaseFindings, CorrectGivenStructureHasNoAlternative) {
  EXPECT_FALSE(found_in(published()).base);
}

TEST(WinningShare, IsTheShareOfDrawsWithALowerLoss) {
  EXPECT_EQ(winning_share({1, 1, 1}, {2, 2, 2}, 1), 1);
  EXPECT_EQ(winning_share({2, 2, 2}, {1, 1, 1}, 1), 0);
  EXPECT_EQ(winning_share({1, 2, 3}, {1, 2, 3}, 1), 0.5);
  EXPECT_NEAR(winning_share({0, 1, 0, 1, 0, 1}, {1, 0, 1, 0, 1, 0}, 1), 0.5, 0.05);
}

}  // namespace
}  // namespace softgrip::sysid::base_findings_test
