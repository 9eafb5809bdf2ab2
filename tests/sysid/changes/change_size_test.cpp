#include "sysid/changes/change_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

}  // namespace
}  // namespace softgrip::sysid::change_size_test
