#include "model/blocks/characteristic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/characteristic_map.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::characteristic_test {
namespace {

using Map = CharacteristicMap<double>;

TEST(Characteristic, PassesThroughZeroAndTheSpan) {
  for (const double a : {-4.0, -1.0, -1e-8, 0.0, 1e-8, 0.5, 4.0}) {
    const Map map{a, 25};
    EXPECT_EQ(map.value(0.0), 0) << a;
    EXPECT_NEAR(map.value(25.0), 25, 1e-12) << a;
  }
}

TEST(Characteristic, EqualsThePublishedExponentialFunction) {
  const Map map{1.7, 20};
  for (double z = 0.5; z < 20; z += 0.5)
    EXPECT_NEAR(map.value(z), 20 * (std::exp(1.7 * z / 20) - 1) / (std::exp(1.7) - 1), 1e-12);
}

TEST(Characteristic, IsMonotoneAndInvertibleEverywhere) {
  for (const double a : {-4.0, -0.7, -1e-10, 0.0, 1e-10, 0.3, 4.0}) {
    const Map map{a, 20};
    double last = map.value(-10.0);
    for (double z = -9.9; z < 40; z += 0.1) {
      EXPECT_GT(map.value(z), last) << a;
      EXPECT_NEAR(map.inverse(map.value(z)), z, 1e-8) << a << " at " << z;
      EXPECT_NEAR(map.slope(z), (map.value(z + 1e-6) - map.value(z - 1e-6)) / 2e-6, 1e-4 * map.slope(z))
          << a << " " << z;
      last = map.value(z);
    }
  }
}

TEST(Characteristic, DoesNotDependOnTheUnit) {
  const Map mm{1.2, 20}, um{1.2, 20'000};
  for (const double z : {-3.0, 4.0, 19.0, 30.0}) EXPECT_NEAR(um.value(1000 * z), 1000 * mm.value(z), 1e-8);
}

}  // namespace
}  // namespace softgrip::model::testing::characteristic_test
