#include "sysid/diagnosis/search/slack.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/blocks/backlash.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/chain.h"
#include "model/named.h"

namespace softgrip::sysid::slack_test {
namespace {

model::Model plays(std::vector<double> values) {
  model::Model m;
  return model::with_block(m, {model::block_type<model::PrandtlIshlinskii>(), std::move(values)});
}

TEST(Slack, ElasticShareIsTheShareOfTheZeroThresholdOperator) {
  EXPECT_DOUBLE_EQ(elastic_share(plays({0, 0, 0, 0, 0, 0.1, 4, 0.3})), 0.25);
  EXPECT_DOUBLE_EQ(elastic_share(plays({0, 0, 0, 0, 2, 0.1, 4, 0.3})), 0);
  EXPECT_DOUBLE_EQ(elastic_share(model::Model{}), 1);
}

/// A play operator with a threshold has the same output for every input as a spring in series with a
/// backlash.
TEST(Slack, BacklashReproducesAPlayOperatorExactly) {
  const model::Model slack = plays({0, 0, 0, 0, 3, 0.2});
  const auto with_backlash = with_slack_as_backlash(slack);
  ASSERT_TRUE(with_backlash);
  EXPECT_EQ(model::find_block<model::Backlash>(*with_backlash)->values.front(), 2 * 3 * 0.2);
  model::Chain<double> one(slack), other(*with_backlash);
  for (int i = 1; i < 400; ++i) {
    const double pressure_kpa = 30 * (1 - std::cos(0.05 * i)) * (1 + 0.3 * std::sin(0.31 * i)) / 2;
    one.step(0.01, pressure_kpa);
    other.step(0.01, pressure_kpa);
    EXPECT_NEAR(one.reading_mm(), other.reading_mm(), 1e-12) << i;
  }
}

TEST(Slack, NoConversionWithoutThresholdOrWithBacklash) {
  EXPECT_FALSE(with_slack_as_backlash(plays({0, 0, 0, 0, 0, 0.2})));
  EXPECT_FALSE(with_slack_as_backlash(model::Model{}));
  EXPECT_FALSE(with_slack_as_backlash(
      model::with_block(plays({0, 0, 0, 0, 3, 0.2}), model::block_of<model::Backlash>({{"gap_mm", 1}}))));
}

}  // namespace
}  // namespace softgrip::sysid::slack_test
