#include "sysid/changes/base_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/blocks/sensor_lag.h"
#include "model/blocks/sensor_saturation.h"
#include "model/blocks/transport_delay.h"
#include "model/named.h"
#include "sysid/changes/filter_bank.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::base_prediction_test {
namespace {

TEST(BasePrediction, HalfSampleDelayEqualsMeanOfAdjacentDriveSamples) {
  const std::vector<Record> records = pressure_records(test::logs_of({}, 1, true), false);
  const Base base = fit_base(records, Judged::pressure, Drive::command, {});
  Extension late;
  late.valve.push_back({model::block_type<model::TransportDelay>(), {0.01}});  // a delay of half the sample
                                                                               // time of 0.02 s
  Record between = records[0];
  for (std::size_t i = 1; i < between.size(); ++i)
    between.drive_kpa[i] = 0.5 * (records[0].drive_kpa[i] + records[0].drive_kpa[i - 1]);
  const std::vector<double> p = predict_base(base, records[0], late);
  const std::vector<double> expected = predict_base(base, between, {});
  for (std::size_t i = 1; i < p.size(); ++i) ASSERT_NEAR(p[i], expected[i], 1e-6) << i;
}

TEST(BasePrediction, LoadLineIsAMapOfTheDrive) {
  for (const Drive drive : {Drive::command, Drive::measured}) {
    const std::vector<Record> records = make_records(test::logs_of({}, 1, true), {.drive = drive});
    Base base = fit_base(records, Judged::displacement, drive, {});
    const Record& record = base.records.front();
    const auto columns = filter_columns(record, record.drive_kpa, base.kind, base.largest_kpa).cols();
    base.filter_weights = Eigen::VectorXd::Constant(columns, 2e-4);
    Record mapped = record;
    for (double& p : mapped.drive_kpa) p = 1.2 * p - 3;
    const Driven driven = driven_by(base, record);
    Extension loaded;
    loaded.load = {1.2, 3};
    const std::vector<double> p = predict_base(base, record, loaded, &driven);
    const Driven expected_drive = driven_by(base, mapped, {}, &driven.start);
    const std::vector<double> expected = predict_base(base, mapped, {}, &expected_drive);
    ASSERT_EQ(p.size(), expected.size());
    double largest_mm = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      ASSERT_NEAR(p[i], expected[i], 1e-9) << i;
      largest_mm = std::max(largest_mm, std::abs(p[i] - driven.plain[i]));
    }
    EXPECT_GT(largest_mm, 0.5);
  }
}

/// Returns a baseline model whose filter bank contributes a large part of the prediction.
Base with_a_large_filter_part() {
  Base base = fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  const Record& record = base.records.front();
  const Eigen::Index columns = filter_columns(record, record.drive_kpa, base.kind, base.largest_kpa).cols();
  base.filter_weights = Eigen::VectorXd::Constant(columns, 2e-4);
  return base;
}

TEST(BasePrediction, SensorSaturationAndLagAlsoActOnTheFilterOutput) {
  const Base base = with_a_large_filter_part();
  const Record record = make_records(test::logs_of({}, 5), {}).front();
  const std::vector<double> plain = predict_base(base, record, {});
  double filters_mm = 0;
  const Driven driven = driven_by(base, record);
  for (const double v : driven.filters) filters_mm = std::max(filters_mm, std::abs(v));
  ASSERT_GT(filters_mm, 0.5);
  Extension limited;
  limited.chain.push_back({model::block_type<model::SensorSaturation>(), {-10.0, 6.0}});
  const std::vector<double> at_most = predict_base(base, record, limited);
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(at_most[i], std::min(plain[i], 6.0), 1e-9);
  Extension lags;
  lags.chain.push_back({model::block_type<model::SensorLag>(), {0.3}});
  const std::vector<double> late = predict_base(base, record, lags), straight = lagged(record, plain, 0.3);
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(late[i], straight[i], 0.005);
}

}  // namespace
}  // namespace softgrip::sysid::base_prediction_test
