#include "sysid/evidence/f_quantile.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::f_quantile_test {
namespace {

TEST(FQuantile, AgreesWithTheTablesOfAbramowitzAndStegun) {
  // The expected values are from Abramowitz and Stegun, table 26.9. The last value is an upper 1 % quantile,
  // and the other values are upper 5 % quantiles.
  EXPECT_NEAR(f_quantile(0.95, 1, 1), 161.4, 0.1);
  EXPECT_NEAR(f_quantile(0.95, 3, 3), 9.28, 0.005);
  EXPECT_NEAR(f_quantile(0.95, 3, 9), 3.86, 0.005);
  EXPECT_NEAR(f_quantile(0.95, 10, 20), 2.35, 0.005);
  EXPECT_NEAR(f_quantile(0.99, 5, 10), 5.64, 0.005);
}

TEST(FQuantile, SwappedDegreesOfFreedomGiveTheReciprocal) {
  for (const double p : {0.05, 0.3, 0.5, 0.9, 0.99})
    EXPECT_NEAR(f_quantile(p, 3, 7) * f_quantile(1 - p, 7, 3), 1, 1e-9) << p;
}

}  // namespace
}  // namespace softgrip::sysid::f_quantile_test
