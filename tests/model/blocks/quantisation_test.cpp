#include "model/blocks/quantisation.h"

#include <gtest/gtest.h>

#include "model/dual.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::quantisation_test {
namespace {

TEST(Quantisation, RoundsToTheNearestStep) {
  auto block = make<Quantisation<double>>({0.25});
  EXPECT_EQ(block.sample(0.12, 0.1, {}), 0);
  EXPECT_EQ(block.sample(0.13, 0.1, {}), 0.25);
  EXPECT_EQ(block.sample(-0.6, 0.1, {}), -0.5);
}

TEST(Quantisation, DerivativesPassUnchanged) {
  const std::vector<Dual<double>> values{Dual<double>(0.25)};
  Quantisation<Dual<double>> block(values, Preparation{});
  const Dual<double> y = block.sample(Dual<double>(0.3, 2.0), Dual<double>(0.1), {});
  EXPECT_DOUBLE_EQ(y.a, 0.25);
  EXPECT_EQ(y.v, 2.0);
}

}  // namespace
}  // namespace softgrip::model::testing::quantisation_test
