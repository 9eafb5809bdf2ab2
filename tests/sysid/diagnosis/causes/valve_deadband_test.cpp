#include "sysid/diagnosis/causes/valve_deadband.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace softgrip::sysid::valve_deadband_test {
namespace {

// The valve sticks and jumps. For every stick band, one start value must be so close that the number of jumps
// up to the largest pressure differs by at most 0.26. A fit from this start value then finds the jumps.
TEST(ValveDeadband, EveryStickBandHasACloseStartValue) {
  Scales scales;
  scales.largest_kpa = 40;
  const std::vector<double> bands = causes::ValveDeadband::Stiction::bands_kpa(scales);
  for (double band = 0.018 * scales.largest_kpa; band < 0.19 * scales.largest_kpa; band *= 1.003) {
    double nearest = 1;
    for (const double start : bands)
      nearest = std::min(nearest, std::fabs(scales.largest_kpa / start - scales.largest_kpa / band));
    EXPECT_LE(nearest, 0.26) << band;
  }
}

}  // namespace
}  // namespace softgrip::sysid::valve_deadband_test
