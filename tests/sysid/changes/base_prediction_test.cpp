#include "sysid/changes/base_prediction.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "model/blocks/sensor_lag.h"
#include "model/blocks/sensor_saturation.h"
#include "model/blocks/transport_delay.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/trajectory.h"
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

model::BlockSpec block(const char* id) {
  return model::default_block(*model::find_block(id));
}

model::Model base() {
  model::Model model;
  for (const char* id :
       {"transport_delay", "asymmetric_valve_lag", "bouc_wen", "kelvin_voigt", "characteristic"})
    model = model::with_block(std::move(model), block(id));
  return model;
}

Record waving() {
  Record record;
  record.name = "waving";
  constexpr double interval_s = 0.02;
  for (int i = 0; i < 400; ++i) {
    const double t = interval_s * i;
    record.time_s.push_back(t);
    record.duration_s.push_back(i > 0 ? interval_s : 0);
    record.drive_kpa.push_back(12 - 10 * std::cos(t) * std::cos(0.3 * t));
    record.reading_mm.push_back(0);
    record.temperature_c.push_back(20 + t);
  }
  record.sample_time_s = interval_s;
  record.largest_kpa = 22;
  record.span_mm = 10;
  record.campaign_time_s = 500;
  return record;
}

std::vector<double> walked(const model::Model& model, const Record& record) {
  return predict(model, record, rest_starts(model, {record}).front());
}

TEST(Downstream, EqualsTheFullSimulationOfDownstreamChains) {
  const Record record = waving();
  const std::vector<double> plain = walked(base(), record);
  const std::vector<std::vector<const char*>> chains{
      {"stiffening"},        {"thermal_gain"},      {"ageing"},
      {"running_in"},        {"contact"},           {"sensor_nonlinearity"},
      {"sensor_drift"},      {"sensor_warm_up"},    {"sensor_piecewise_drift"},
      {"sensor_saturation"}, {"contact", "ageing"}, {"thermal_gain", "contact", "periodic_disturbance"}};
  for (const auto& chain : chains) {
    SCOPED_TRACE(chain.front());
    model::Model whole = base();
    std::vector<model::BlockSpec> blocks;
    for (const char* id : chain) {
      blocks.push_back(block(id));
      whole = model::with_block(std::move(whole), blocks.back());
    }
    if (!is_downstream(blocks, base(), record)) {
      // In the signal path, ageing comes before the contact, so {contact, ageing} is in the wrong order.
      EXPECT_STREQ(chain.back(), "ageing");
      continue;
    }
    EXPECT_EQ(downstream(blocks, record, plain), walked(whole, record));
  }
}

// is_downstream() returns true if a block can be applied to the samples of a prediction, so that the model is
// not simulated again. For such a block, the result must equal the simulation of the model with the block.
TEST(Downstream, EqualsTheFullSimulationForEveryDownstreamBlock) {
  const Record record = waving();
  const std::vector<double> plain = walked(base(), record);
  std::size_t count = 0;
  for (std::size_t type = 0; type < model::catalogue().size(); ++type) {
    const model::BlockSpec one = model::default_block(type);
    if (!is_downstream({one}, base(), record)) continue;
    ++count;
    EXPECT_EQ(downstream({one}, record, plain), walked(model::with_block(base(), one), record))
        << model::catalogue()[type].info.id;
  }
  EXPECT_GE(count, 10U);
}

TEST(Downstream, RejectsDynamicRandomAndUpstreamBlocks) {
  const Record record = waving();
  for (const char* id : {"backlash", "inertia", "sensor_lag", "wear", "slow_creep", "stress_softening",
                         "valve_deadband", "sensor_noise", "outliers"})
    EXPECT_FALSE(is_downstream({block(id)}, base(), record)) << id;
  EXPECT_FALSE(is_downstream({block("contact")}, model::with_block(base(), block("sensor_drift")), record));
  EXPECT_FALSE(is_downstream({block("contact")}, {}, record));
}

TEST(Downstream, RejectsHeldCommandsAndUnknownStarts) {
  Record held = waving(), unknown = waving();
  held.held = true;
  unknown.start_unknown = true;
  EXPECT_FALSE(is_downstream({block("contact")}, base(), held));
  EXPECT_FALSE(is_downstream({block("contact")}, base(), unknown));
}

}  // namespace

}  // namespace softgrip::sysid::base_prediction_test
