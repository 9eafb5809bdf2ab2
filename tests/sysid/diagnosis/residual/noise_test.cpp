#include "sysid/diagnosis/residual/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace softgrip::sysid::noise_test {
namespace {

/// Returns a record of a slow motion. The readings have a noise of 0.02 mm. Only every `every`-th sample has
/// a reading.
Record record_read_every(int every) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.02);
  Record record;
  for (int i = 0; i < 4000; ++i) {
    const double reading = 5 * std::sin(0.0005 * i) + noise(random);
    record.reading_mm.push_back(i % every == 0 ? reading : std::numeric_limits<double>::quiet_NaN());
  }
  return record;
}

TEST(MeasuredNoise, IsIndependentOfTheSpacingOfReadings) {
  for (const int every : {1, 2, 5, 20})
    EXPECT_NEAR(measured_noise_mm({record_read_every(every)}), 0.02, 0.004) << every;
}

}  // namespace
}  // namespace softgrip::sysid::noise_test
