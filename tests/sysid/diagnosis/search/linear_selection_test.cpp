#include "sysid/diagnosis/search/linear_selection.h"

#include <gtest/gtest.h>

#include "model/blocks/asymmetric_bouc_wen.h"
#include "model/blocks/backlash.h"
#include "model/blocks/pressure_saturation.h"
#include "model/blocks/sensor_lag.h"
#include "model/blocks/stress_softening.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/scored.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::linear_selection_test {
namespace {

using model::SignalName;

model::Model finger() {
  return model::only(loaded("bench_twin"),
                     [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
}

struct Campaign {
  SearchData data;
  StructureFit base;
  Division division;
};

Campaign campaign_of(const model::Model& truth) {
  std::vector<Log> logs;
  for (const SignalName signal : {SignalName::tp1, SignalName::sp2})
    logs.push_back(simulated(truth, signal, 25, 0.03, 3));
  Campaign c;
  c.data = make_search_data(make_records(logs, {}), finger());
  c.base = fit_structure(c.data.records, {}, c.data.given);
  c.division = divide(c.data.records, 8);
  return c;
}

model::Model softening() {
  return model::with_block(finger(), model::block_of<model::StressSoftening>({{"softening_per_kpa", 0.001}}));
}

/// Compares the approximate held-out losses of the linearised model with exact losses. For the exact losses,
/// the model is refitted without each held-out block.
TEST(LinearHoldout, MatchesTheLossesOfRefittedModels) {
  const Campaign c = campaign_of(softening());
  const BlockLosses refitted = held_out_losses(c.data.records, c.division, c.base);
  const BlockLosses linear = linear_held_out_losses(c.data.records, c.division, c.base);
  ASSERT_EQ(linear.size(), refitted.size());
  for (std::size_t b = 0; b < linear.size(); ++b)
    EXPECT_NEAR(linear[b], refitted[b], 0.1 * refitted[b]) << "block " << b;
}

/// Compares the linear search with the full search, which varies all parameters of the model structure.
TEST(LinearSelection, FindsTheSameCauseAsTheFullSearch) {
  const std::vector<model::BlockSpec> effects{
      model::block_of<model::Backlash>({{"gap_mm", 0.4}}),
      model::block_of<model::SensorLag>({{"time_constant_s", 0.15}}),
      model::block_of<model::PressureSaturation>({{"limit_kpa", 38}})};
  for (const model::BlockSpec& effect : effects) {
    const Campaign c = campaign_of(model::with_block(finger(), effect));
    const Selection found = select_causes_upon(c.data, c.base, 0.03, c.division, {});
    const Selection full = select_causes(c.data, c.base, 0.03, c.division, {});
    const std::string name(model::catalogue()[effect.type].info.id);
    ASSERT_EQ(found.chosen.size(), 1U) << name << ": " << found.last_candidates.front().why_not;
    ASSERT_EQ(full.chosen.size(), 1U) << name;
    EXPECT_EQ(found.chosen.front().cause, full.chosen.front().cause) << name;
    EXPECT_EQ(found.chosen.front().cause.id, name);
    EXPECT_NEAR(rmse_mm(found.extended_losses), rmse_mm(full.extended_losses), 0.02 * 0.03) << name;
    EXPECT_FALSE(found.left.present) << name;
    const model::Model& model = found.extended.point.model;
    const double fitted = model.blocks[*position_of(model, found.chosen.front().cause)].values[0];
    EXPECT_NEAR(fitted, effect.values[0], 0.1 * effect.values[0]) << name;
  }
}

TEST(LinearSelection, FindsNoCauseForACorrectModelStructure) {
  const Campaign c = campaign_of(finger());
  const Selection found = select_causes_upon(c.data, c.base, 0.03, c.division, {});
  EXPECT_TRUE(found.chosen.empty());
  EXPECT_EQ(found.extended.mean_square_mm2, c.base.mean_square_mm2);
}

TEST(LinearSelection, FindsBothOfTwoCauses) {
  model::Model truth = model::with_block(finger(), model::block_of<model::Backlash>({{"gap_mm", 0.4}}));
  truth = model::with_block(truth, model::block_of<model::SensorLag>({{"time_constant_s", 0.15}}));
  const Campaign c = campaign_of(truth);
  const Selection found = select_causes_upon(c.data, c.base, 0.03, c.division, {});
  ASSERT_EQ(found.chosen.size(), 2U);
  EXPECT_TRUE(position_of(found.extended.point.model, *find_cause("backlash")));
  EXPECT_TRUE(position_of(found.extended.point.model, *find_cause("sensor_lag")));
}

/// The hysteresis loop differs slightly from every loop that the model structure can describe. If this
/// difference is smaller than the noise, no cause may be named for it.
TEST(LinearSelection, LoopShapeErrorBelowTheNoiseIsNoCause) {
  for (const bool clear : {false, true}) {
    const Campaign c = campaign_of(model::with_block(
        finger(), model::block_of<model::AsymmetricBoucWen>({{"beta_share", clear ? 0.08 : 0.02}})));
    const Selection found = select_causes_upon(c.data, c.base, 0.03, c.division, {});
    ASSERT_TRUE(found.base_unexplained.present);
    EXPECT_EQ(found.base_unexplained.excess_mm > 0.03, clear) << found.base_unexplained.excess_mm;
    EXPECT_EQ(found.last_candidates.empty(), !clear) << "no cause is tested if the residual is only noise";
    EXPECT_EQ(found.chosen.size(), clear ? 1U : 0U);
    for (const ChosenCause& one : found.chosen) EXPECT_EQ(one.cause.id, "asymmetric_hysteresis");
  }
}

TEST(Weigh, ErrorReductionIsTheLossWithoutMinusWithTheCause) {
  const Campaign c = campaign_of(finger());
  const Cause cause = *find_cause("stress_softening");
  const BlockLosses with{1, 1, 1, 1}, without{2, 2, 2, 2};
  StructureFit fit = c.base;
  fit.point.model = softening();
  const ChosenCause alone = weigh(cause, {fit, with, without, 0.03, 1}, {});
  EXPECT_TRUE(alone.alternatives.empty());
  EXPECT_EQ(alone.inclusion, 1);
  EXPECT_NEAR(alone.gain_mm2.value, 1, 1e-12);
}

/// If the input of the model is the measured pressure, the residual contains no error of the valve. A cause
/// may then be named even if its error reduction is small, provided that the error decreases in most blocks.
/// If the input is the command, the limits are stricter, and the same cause is rejected.
TEST(LinearSelection, MeasuredPressureAllowsASmallerErrorReduction) {
  const Campaign c =
      campaign_of(model::with_block(finger(), model::block_of<model::Backlash>({{"gap_mm", 0.1}})));
  SelectionOptions measured;
  measured.least_taken = from_the_measured_pressure;
  EXPECT_TRUE(select_causes_upon(c.data, c.base, 0.03, c.division, {}).chosen.empty());
  const Selection found = select_causes_upon(c.data, c.base, 0.03, c.division, measured);
  ASSERT_EQ(found.chosen.size(), 1U);
  EXPECT_EQ(found.chosen.front().cause.id, "backlash");
}

}  // namespace
}  // namespace softgrip::sysid::linear_selection_test
