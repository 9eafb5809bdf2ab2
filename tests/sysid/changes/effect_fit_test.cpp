#include "sysid/changes/effect_fit.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace softgrip::sysid::effect_fit_test
