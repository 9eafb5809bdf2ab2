#include "sysid/changes/regulator_fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sysid/changes/regulator_records.h"

namespace softgrip::sysid::regulator_fit_test {
namespace {

using test::record_of;
using test::rms;

TEST(RegulatorFit, RecoversARegulatorFromMeasuredPressure) {
  const Regulator truth{.play_kpa = 0.2,
                        .dead_kpa = 0.9,
                        .full_kpa = 15,
                        .integral_per_s = 3,
                        .port_per_s = 3,
                        .tube_per_s = 6,
                        .spool_lag_s = 0.02,
                        .chamber_share = 0.3};
  Record record = record_of(test::command_kpa(3, 6000, 100), 0.01);
  const std::vector<double> p = regulated(truth, record, record.drive_kpa);
  for (std::size_t i = 0; i < p.size(); ++i) record.reading_mm[i] = 1.01 * p[i] + 0.5;
  const Regulator found = fit_regulator({record}, 60, ReadBy::gauge);
  EXPECT_LT(rms(behind(found, record).drive_kpa, p), 0.02);
  EXPECT_NEAR(found.integral_per_s, truth.integral_per_s, 0.3);
}

TEST(RegulatorFit, RecoversThePressureFromFingerDisplacement) {
  const Regulator truth{.play_kpa = 0.3,
                        .dead_kpa = 0.9,
                        .full_kpa = 20,
                        .integral_per_s = 1,
                        .port_per_s = 2,
                        .tube_per_s = 5};
  Record record = record_of(test::command_kpa(3, 6000, 100), 0.01);
  const std::vector<double> p = regulated(truth, record, record.drive_kpa);
  double play = 0, creep = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    play = std::clamp(play, p[i] - 3, p[i] + 3);
    creep += (p[i] - creep) / 400;
    record.reading_mm[i] = 0.2 * (0.6 * p[i] + 0.3 * play + 0.1 * creep);
  }
  const Regulator found = fit_regulator({record}, 60);
  const double far_kpa = rms(record.drive_kpa, p);
  EXPECT_GT(far_kpa, 0.5);
  EXPECT_LT(rms(behind(found, record).drive_kpa, p), 0.2 * far_kpa);
}

}  // namespace
}  // namespace softgrip::sysid::regulator_fit_test
