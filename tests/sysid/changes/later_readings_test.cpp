#include "sysid/changes/later_readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::later_readings_test {
namespace {

/// Returns the end of each log, from the first sample whose pressure exceeds half of the largest pressure.
std::vector<Log> under_pressure(std::vector<Log> logs) {
  for (Log& log : logs) {
    const std::vector<double>& command = log.pressure_command_kpa;
    const double half_kpa = *std::max_element(command.begin(), command.end()) / 2;
    const auto first =
        std::find_if(command.begin(), command.end(), [&](double kpa) { return kpa > half_kpa; });
    log = slice(log, static_cast<std::size_t>(first - command.begin()), log.size());
  }
  return logs;
}

std::vector<Log> with_transient(std::vector<Log> logs) {
  for (Log& log : logs) {
    for (std::size_t i = 0; i < log.size(); ++i) log.displacement_mm[i] += 2 * std::exp(-log.time_s[i] / 9);
  }
  return logs;
}

TEST(LaterReadings, ATransientIsNoChangeIfNoHealthyRecordBeginsAlike) {
  const Base base = fit_base(make_records(under_pressure(test::logs_of({}, 1)), {}), Judged::displacement,
                             Drive::command, {});
  const auto readings = [&](const std::vector<Log>& logs) {
    const std::vector<Record> records = make_records(logs, {});
    return readings_of(base, records, residuals_of(base, records));
  };
  const std::vector<Log> at_rest = test::logs_of({}, 5);
  const LaterReadings plain = readings(at_rest), moved = readings(with_transient(at_rest));
  EXPECT_EQ(moved.other_starts(), (std::vector<std::string>{at_rest[0].name, at_rest[1].name}));
  EXPECT_LT(moved.plain_rms({}), 1.5 * plain.plain_rms({}));
  EXPECT_LT(moved.white({}).norm(), 1.5 * plain.white({}).norm());
  // The transients are fitted and removed. If the gain has changed, the effect of this change must remain.
  EXPECT_GT(readings(test::logs_of({.gain = 0.85 * 0.2}, 5)).plain_rms({}), 3 * plain.plain_rms({}));

  const std::vector<Log> alike = under_pressure(at_rest);
  const LaterReadings alike_moved = readings(with_transient(alike));
  EXPECT_TRUE(alike_moved.other_starts().empty());
  EXPECT_GT(alike_moved.plain_rms({}), 2 * readings(alike).plain_rms({}));
}

TEST(LaterReadings, EachRecordHasItsOwnGainWithinTheSpread) {
  const auto records_of = [](double first, double second, unsigned seed) {
    return make_records(
        {test::log_of({.gain = 0.2 * first}, seed), test::log_of({.gain = 0.2 * second}, seed + 1)}, {});
  };
  std::vector<Record> healthy = records_of(1.02, 0.98, 1);
  for (Record& record : records_of(1.01, 0.99, 3)) healthy.push_back(std::move(record));
  const Base base = fit_base(healthy, Judged::displacement, Drive::command, {});
  const auto readings = [&](double first, double second) {
    const std::vector<Record> records = records_of(first, second, 5);
    return readings_of(base, records, residuals_of(base, records));
  };
  const LaterReadings same = readings(1, 1), different = readings(1.02, 0.98);
  EXPECT_LT(different.plain_rms({}), 1.2 * same.plain_rms({}));
  EXPECT_LT(different.white({}).norm(), 1.2 * same.white({}).norm());
  EXPECT_NEAR(different.nuisance({}).gain, 0, 0.01);
  const Eigen::VectorXd gains = base.gain_spread * different.white_and_gain({}).tail(2);
  EXPECT_NEAR(gains(0) - gains(1), 0.04, 0.008);
  EXPECT_GT(readings(0.85, 0.85).plain_rms({}), 3 * same.plain_rms({}));
  EXPECT_LT(readings(1, 0.85).without_record(1).plain_rms({}), 1.2 * same.plain_rms({}));
}

}  // namespace
}  // namespace softgrip::sysid::later_readings_test
