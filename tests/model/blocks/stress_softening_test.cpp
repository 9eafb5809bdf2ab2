#include "model/blocks/stress_softening.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::stress_softening_test {
namespace {

using Block = StressSoftening<double>;

TEST(StressSoftening, GainIncreasesWithTheLargestLoad) {
  Block block = make<Block>({0.01, 0.0});
  const std::vector<double> out = drive(block, 0, std::vector<double>{20, 0, 10, 20, 40, 10}, 1.0);
  EXPECT_NEAR(out[0], 20 * 1.2, 1e-12);
  EXPECT_NEAR(out[2], 10 * 1.2, 1e-12);  // after the load of 20 kPa, the factor is 1.2; during the first
                                         // rise, it was 1.1 at 10 kPa
  EXPECT_NEAR(out[3], out[0], 1e-12);
  EXPECT_NEAR(out[4], 40 * 1.4, 1e-12);
  EXPECT_NEAR(out[5], 10 * 1.4, 1e-12);
  EXPECT_EQ(block.largest_kpa(), 40);
}

TEST(StressSoftening, MeanIsCorrectForARiseBeyondTheLargestLoad) {
  Block once = make<Block>({0.01, 0.0}), often = make<Block>({0.01, 0.0});
  for (Block* block : {&once, &often}) drive(*block, 0, std::vector<double>{20, 0}, 1.0);
  double mean = 0, fine = 0;
  for (const auto& s : pass(once, Segment<double>::straight(1.0, 0, 50))) mean += s.mean * s.duration_s;
  for (int i = 0; i < 1000; ++i) {
    for (const auto& s : pass(often, Segment<double>::straight(1e-3, 0.05 * i, 0.05 * (i + 1)))) {
      fine += s.mean * s.duration_s;
    }
  }
  EXPECT_NEAR(mean, fine, 1e-9);
  EXPECT_NEAR(once.output(), often.output(), 1e-12);
}

TEST(StressSoftening, SofteningSaturatesForLargerLoads) {
  Block block = make<Block>({0.01, 0.05});
  const std::vector<double> out = drive(block, 0, std::vector<double>{20, 10, 40, 10}, 1.0);
  EXPECT_NEAR(out[0], 20 * (1 + 0.2 / 2), 1e-12);
  EXPECT_NEAR(out[1], 10 * (1 + 0.2 / 2), 1e-12);
  EXPECT_NEAR(out[3], 10 * (1 + 0.4 / 3), 1e-12);
  // Compares two means of the output over a pressure rise within one sample. The block computes its mean with
  // Simpson's rule. The test averages the means of 1000 shorter steps.
  Block once = make<Block>({0.01, 0.05}), often = make<Block>({0.01, 0.05});
  double fine = 0;
  for (int i = 0; i < 1000; ++i)
    fine += pass(often, Segment<double>::straight(1e-3, 2e-3 * i, 2e-3 * (i + 1))).front().mean / 1000;
  EXPECT_NEAR(pass(once, Segment<double>::straight(1.0, 0, 2)).front().mean, fine, 1e-5);
}

}  // namespace
}  // namespace softgrip::model::testing::stress_softening_test
