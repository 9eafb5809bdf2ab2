#include "sysid/changes/change_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_size_test {
namespace {

class FullPressure : public test::PressureBase {
 protected:
  /// Returns the mean, at full pressure, of an effect that is the magnitude of the drive.
  [[nodiscard]] double of_records(std::vector<Record> records) const {
    Binned none, added;
    for (const Record& record : records) {
      added.push_back(binned(record, record.drive_kpa, base_.bin_s));
      none.emplace_back(added.back().size(), 0.0);
      for (double& each : added.back()) each = std::abs(each);
    }
    return at_full_pressure(LaterReadings(base_, std::move(records), none), added);
  }
};

TEST_F(FullPressure, OfAVacuumActuatorIsItsStrongestVacuum) {
  std::vector<Record> vacuum = base_.records;
  double largest_kpa = 0;
  for (Record& record : vacuum) {
    largest_kpa = std::max(largest_kpa, record.largest_kpa);
    for (double& kpa : record.drive_kpa) kpa = -kpa;
  }
  const double by_pressure = of_records(base_.records);
  EXPECT_GT(by_pressure, 0.9 * largest_kpa);
  EXPECT_DOUBLE_EQ(of_records(vacuum), by_pressure);
}

class WholeGain : public test::PressureBase {
 protected:
  /// Returns the parameter of an effect on the pressure before the model, after the fit left another gain
  /// deviation of -4 %. The model is linear.
  [[nodiscard]] double number_of(const std::string& name) const {
    Effect effect;
    effect.numbers = {{name, "", 0.01, -0.9, 9}};
    effect.apply = [](Extension& e, const std::vector<double>& n) { e.load.factor *= 1 + n[0]; };
    return with_whole_gain(healthy_readings(base_), {effect, {-0.06}}, -0.04).numbers.front();
  }
};

TEST_F(WholeGain, IsInTheParameterOfAGainOrOfAModulus) {
  EXPECT_NEAR(number_of("gain_change"), -0.10, 0.001);
  EXPECT_NEAR(number_of("pressure_factor_change"), -0.10, 0.001);
  EXPECT_EQ(number_of("band_kpa"), -0.06);
}

}  // namespace
}  // namespace softgrip::sysid::change_size_test
