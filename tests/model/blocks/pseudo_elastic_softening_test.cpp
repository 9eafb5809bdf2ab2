#include "model/blocks/pseudo_elastic_softening.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/model/drive.h"

namespace softgrip::model::testing::pseudo_elastic_softening_test {
namespace {

using Block = PseudoElasticSoftening<double>;

TEST(PseudoElasticSoftening, HasNoEffectDuringFirstLoading) {
  Block block = make<Block>({0.01, 10.0});
  EXPECT_EQ(drive(block, 0, std::vector<double>{10, 20, 40}, 1.0), (std::vector<double>{10, 20, 40}));
  EXPECT_EQ(block.largest_kpa(), 40);
}

// Compares the output of the block with the published formula. This formula gives the input as a function of
// the output, so the test needs no iteration.
TEST(PseudoElasticSoftening, FollowsThePublishedFormulaBelowTheLargestLoad) {
  Block block = make<Block>({0.01, 10.0});
  drive(block, 0, std::vector<double>{40}, 1.0);
  double from = 40;
  for (const double to : {39.9, 37.0, 30.0, 20.0, 5.0, 0.1}) {
    const double q = drive(block, from, std::vector<double>{to}, 1.0).front();
    from = to;
    EXPECT_GT(q, to);
    EXPECT_NEAR(q / (1 + 0.01 * 40 * std::tanh((40 - q) / 10)), to, 1e-12);
  }
}

TEST(PseudoElasticSoftening, ReloadingFollowsTheUnloadingCurveToTheLargestLoad) {
  Block block = make<Block>({0.01, 10.0});
  const std::vector<double> out = drive(block, 0, std::vector<double>{40, 25, 0, 25, 40, 45, 25}, 1.0);
  EXPECT_NEAR(out[3], out[1], 1e-12);
  EXPECT_NEAR(out[4], 40, 1e-12);
  EXPECT_EQ(out[5], 45);
  EXPECT_GT(out[6], out[1]);  // the load of 45 kPa has softened the finger more than the load of 40 kPa
}

// With these parameters, a softening factor that multiplies the pressure would decrease faster than the
// pressure rises. The output would then fall while the pressure rises.
TEST(PseudoElasticSoftening, IsMonotoneForExtremeParameters) {
  Block block = make<Block>({0.5, 0.5});
  drive(block, 0, std::vector<double>{50}, 1.0);
  double last = 50;
  for (int i = 1; i <= 5000; ++i) {
    const double q = drive(block, 50 - 0.01 * (i - 1), std::vector<double>{50 - 0.01 * i}, 1.0).front();
    ASSERT_LE(q, last + 1e-12) << i;
    last = q;
  }
  EXPECT_NEAR(last, 0, 1e-9);
}

TEST(PseudoElasticSoftening, MeanIsCorrectForAStepAcrossTheLargestLoad) {
  Block once = make<Block>({0.01, 10.0}), often = make<Block>({0.01, 10.0});
  for (Block* block : {&once, &often}) drive(*block, 0, std::vector<double>{20, 18}, 1.0);
  double mean = 0, fine = 0;
  for (const auto& s : pass(once, Segment<double>::straight(1.0, 18, 23))) mean += s.mean * s.duration_s;
  for (int i = 0; i < 1000; ++i) {
    const double a = 18 + 0.005 * i;
    for (const auto& s : pass(often, Segment<double>::straight(1e-3, a, a + 0.005)))
      fine += s.mean * s.duration_s;
  }
  EXPECT_NEAR(mean, fine, 1e-5);
  EXPECT_NEAR(once.output(), often.output(), 1e-12);
}

}  // namespace
}  // namespace softgrip::model::testing::pseudo_elastic_softening_test
