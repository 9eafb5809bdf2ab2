#include "sysid/changes/effect_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "sysid/changes/effects.h"
#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::effect_fit_test {
namespace {

TEST(EffectFit, TheStepOfAParameterStaysWithinItsBounds) {
  FittedEffect fitted;
  fitted.effect.numbers = {{"share", "", 1, 0, 2}};
  fitted.numbers = {1};
  const double step = small_move(fitted, 0);
  EXPECT_GT(step, 0);
  EXPECT_LT(step, 0.1);
  fitted.numbers = {2};
  EXPECT_LT(small_move(fitted, 0), 0) << "the parameter is at its upper bound";
  fitted.numbers = {0};
  EXPECT_GT(small_move(fitted, 0), 0) << "the step is not 0 for a parameter value of 0";
}

class DelayFit : public test::PressureBase {
 protected:
  static Effect delay_of(const std::vector<Effect>& effects, std::vector<std::vector<double>> starts) {
    Effect effect = *std::find_if(effects.begin(), effects.end(),
                                  [](const Effect& each) { return each.id == "transport_delay"; });
    effect.starts = std::move(starts);
    return effect;
  }
};

TEST_F(DelayFit, StartPointsWithoutInfluenceDoNotEndTheFit) {
  const LaterReadings later = readings({.delay_s = 0.06});
  const std::vector<Effect> effects = effects_for(base_, later.records(), {}, true);
  const Eigen::VectorXd without = later.white({});
  const EffectFit fit = fit_effect(later, delay_of(effects, {{0.0}, {0.04}, {0.0}}), {}, without);
  EXPECT_NEAR(fit.fitted.numbers.front(), 0.06, 0.01);
  const EffectFit none = fit_effect(later, delay_of(effects, {{0.0}, {0.0}}), {}, without);
  EXPECT_EQ(none.white, without) << "without influence, the effect explains nothing";
}

}  // namespace
}  // namespace softgrip::sysid::effect_fit_test
