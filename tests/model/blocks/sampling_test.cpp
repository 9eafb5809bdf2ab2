#include "model/blocks/sampling.h"

#include <gtest/gtest.h>

#include "tests/model/drive.h"

namespace softgrip::model::testing::sampling_test {
namespace {

TEST(Sampling, ReadingIsConstantDuringTheSamplingInterval) {
  Sampling<double> block = make<Sampling<double>>({0.1});
  block.reset(0);
  for (int i = 1; i <= 100; ++i) {
    block.sample(i, 0.02, {});
    EXPECT_DOUBLE_EQ(block.output(), i - i % 5) << i;
  }
}

TEST(Sampling, ANonIntegerIntervalIsCorrectOnAverage) {
  Sampling<double> block = make<Sampling<double>>({0.07});
  block.reset(-1);
  int updates = 0;
  for (int i = 0; i < 700; ++i) {
    const double before = block.output();
    updates += block.sample(i, 0.02, {}) != before ? 1 : 0;
  }
  EXPECT_NEAR(updates, 700 * 0.02 / 0.07, 1);
}

}  // namespace
}  // namespace softgrip::model::testing::sampling_test
