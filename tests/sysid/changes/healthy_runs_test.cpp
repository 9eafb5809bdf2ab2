#include "sysid/changes/healthy_runs.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::healthy_runs_test {
namespace {

class HealthyRuns : public test::PressureBase {
 protected:
  [[nodiscard]] std::vector<HealthyFits> units() const {
    std::vector<HealthyFits> units;
    const LaterReadings all = healthy_readings(base_);
    for (std::size_t unit = 0; unit < base_.units.count(); ++unit)
      units.push_back({all.only(base_.units, unit), {}});
    return units;
  }
};

TEST_F(HealthyRuns, AreWithinTheirOwnSpread) {
  const std::vector<HealthyFits> healthy = units();
  const RunSpread spread(healthy, base_.units.runs());
  EXPECT_GT(spread.usual_rms(), 0);
  EXPECT_GE(spread.allowed_rms(), spread.usual_rms());
  for (const HealthyFits& unit : healthy) {
    const double rms = unit.readings.plain_rms({});
    const double loss = per_bin(unit.readings, unit.readings.white({}));
    EXPECT_FALSE(spread.admits_a_change(rms, loss));
  }
}

TEST_F(HealthyRuns, DelayExceedsTheSpreadOfHealthyRuns) {
  const RunSpread spread(units(), base_.units.runs());
  const LaterReadings later = readings({.delay_s = 0.06});
  EXPECT_TRUE(spread.is_exceeded(later.plain_rms({}), per_bin(later, later.white({}))));
}

}  // namespace
}  // namespace softgrip::sysid::healthy_runs_test
