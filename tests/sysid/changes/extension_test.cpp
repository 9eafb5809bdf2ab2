#include "sysid/changes/extension.h"

#include <gtest/gtest.h>

#include "model/blocks/stiffening.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::extension_test {
namespace {

Record record() {
  return make_records(test::logs_of({}, 1), {}).front();
}

TEST(Extension, ADelayShiftsTheDrive) {
  const Record r = record();
  const std::vector<double> late = drive_behind({{model::block_type<model::TransportDelay>(), {0.2}}}, r);
  for (std::size_t i = 10; i < r.size(); ++i) EXPECT_NEAR(late[i], r.drive_kpa[i - 10], 1e-9);
  EXPECT_EQ(drive_behind({}, r), r.drive_kpa);
}

TEST(Extension, ValveBlocksMergeWithModelBlocksOfTheSameType) {
  const model::BlockSpec delay{model::block_type<model::TransportDelay>(), {0.2}};
  const model::BlockSpec lag{model::block_type<model::ValveLag>(), {0.03}};
  const model::BlockSpec no_lag{lag.type, {0.0}};
  const model::Model none = model::with_block({}, {model::block_type<model::Stiffening>(), {0.01}});
  EXPECT_EQ(with_valve(none, {delay, lag}), model::with_block(model::with_block(none, delay), lag));
  const model::Model own = model::with_block(model::with_block(none, delay), no_lag);
  const auto both = with_valve(own, {delay, lag});
  ASSERT_TRUE(both);
  EXPECT_EQ(model::value_in<model::TransportDelay>(*both, "delay_s"), 0.4);
  EXPECT_EQ(model::value_in<model::ValveLag>(*both, "time_constant_s"), 0.03);
  EXPECT_FALSE(with_valve(model::with_block(none, lag), {lag}));
}

TEST(Extension, LeakLowersTheHeldPressureUntilTheCommandMoves) {
  Record r = record();
  r.largest_kpa = 40;
  r.drive_kpa.assign(r.size(), 40.0);
  for (std::size_t i = 1000; i < r.size(); ++i) r.drive_kpa[i] = i % 2 == 0 ? 40.0 : 20.0;
  const std::vector<double> p = pressure_behind({}, {0.5, 1e6, 1.0}, r, std::vector<double>(r.size(), 40.0));
  EXPECT_NEAR(40 - p[500], 0.5 * 10, 0.1);  // pressure loss of 0.5 kPa/s during 10 s
  EXPECT_LT(40 - p[1100], 0.05);
  EXPECT_EQ(pressure_behind({}, {}, r, r.drive_kpa), r.drive_kpa);
}

TEST(Extension, AClockOffsetShiftsTheSeriesBetweenSamples) {
  Record r;
  r.time_s = {0, 0.1, 0.3, 0.4, 1};
  std::vector<double> series{0, 1, 5, 5, 11};
  const std::vector<double> early = leading_by(0.25, r, series);
  const std::vector<double> expected{4, 5, 6.5, 7.5, 11};  // at 0.25, 0.35, 0.55, 0.65 and 1.25 s
  ASSERT_EQ(early.size(), expected.size());
  for (std::size_t i = 0; i < early.size(); ++i) EXPECT_NEAR(early[i], expected[i], 1e-12) << i;
  EXPECT_EQ(leading_by(0, r, series), series);
}

TEST(Extension, EffectsOnAVacuumActuatorMirrorThoseOnAPressureActuator) {
  const Record r = record();
  Record vacuum = r;
  for (double& p : vacuum.drive_kpa) p = -p;
  EXPECT_EQ(softened({0.1, 5}, vacuum, 60), softened({0.1, 5}, r, 60));
  EXPECT_EQ(added_by({0.1, 2}, vacuum, 60), added_by({0.1, 2}, r, 60));
  const std::vector<double> p = pressure_behind({}, {0.5, 5, 2}, r, r.drive_kpa);
  const std::vector<double> mirrored = pressure_behind({}, {0.5, 5, 2}, vacuum, vacuum.drive_kpa);
  ASSERT_NE(p, r.drive_kpa);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(mirrored[i], -p[i]) << i;
}

TEST(Extension, SofteningStartsBelowThePreviousLargestPressure) {
  Record r = record();
  r.drive_kpa.assign(r.size(), 20.0);
  r.drive_kpa[10] = 60;
  const std::vector<double> factor = softened({0.1, 5}, r, 60);
  EXPECT_EQ(factor[5], 1);
  EXPECT_EQ(factor[10], 1);
  EXPECT_NEAR(factor[20], 1.1, 1e-6);
}

TEST(Extension, CrescentLowersLoadingAndRaisesUnloading) {
  Record r = record();
  const auto samples = static_cast<double>(r.size());
  for (std::size_t i = 0; i < r.size(); ++i)  // the pressure rises to 60 kPa and falls to 0
    r.drive_kpa[i] = 60 * (1 - std::abs(2 * static_cast<double>(i) / samples - 1));
  const std::vector<double> added = added_by({0.2, 3}, r, 60);
  const std::size_t half = r.size() / 4;  // first sample whose pressure is at least half of the largest
                                          // pressure
  EXPECT_NEAR(added[half], -0.2 * 0.5 * (0.5 - 0.125), 1e-3);
  EXPECT_NEAR(added[r.size() - half], 0.2 * 0.5 * (0.5 - 0.125), 1e-3);
  EXPECT_NEAR(added[0], 0, 1e-3);
  EXPECT_NEAR(added[r.size() / 2], 0, 1e-3);
}

TEST(Extension, ABlockedLineFillsMoreSlowlyThanItEmpties) {
  Record r = record();
  std::vector<double> step(r.size(), 0.0);
  for (std::size_t i = 100; i < 500; ++i) step[i] = 10;
  const std::vector<double> p = pressure_behind({1.0, 0.2}, {}, r, step);
  EXPECT_NEAR(p[100 + 50 - 1], 10 * (1 - std::exp(-1)), 0.1);  // 1 s after the rising step, which is the time
                                                               // constant of filling
  EXPECT_NEAR(p[500 + 10 - 1], 10 * std::exp(-1), 0.2);        // 0.2 s after the falling step, which is the
                                                               // time constant of venting
}

TEST(FilterBank, LagIsExactForLinearInputBetweenSamples) {
  Record r = record();
  std::vector<double> ramp(r.size());
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 2 * r.time_s[i];
  const std::vector<double> lag = lagged(r, ramp, 0.5);
  for (const std::size_t i : {10UL, 500UL})
    EXPECT_NEAR(lag[i], 2 * (r.time_s[i] - 0.5 * (1 - std::exp(-r.time_s[i] / 0.5))), 1e-9);
}

TEST(FilterBank, ColumnsDependOnTheRecordedSupplyPressure) {
  Record r = record();
  const Eigen::MatrixXd plain = filter_columns(r, r.drive_kpa, FilterKind::valve, 60);
  EXPECT_EQ(plain.rows(), static_cast<Eigen::Index>(r.size()));
  EXPECT_TRUE(plain.allFinite());
  r.supply_kpa.assign(r.size(), 500.0);
  r.supply_kpa[r.size() / 2] = 400.0;
  const Eigen::MatrixXd supplied = filter_columns(r, r.drive_kpa, FilterKind::valve, 60);
  ASSERT_EQ(supplied.cols(), plain.cols());
  EXPECT_NE(supplied, plain);
}

TEST(FilterBank, CommandBankCombinesValveAndFingerColumns) {
  const Record r = record();
  const auto columns = [&](FilterKind kind) { return filter_columns(r, r.drive_kpa, kind, 60).cols(); };
  // Columns without a delay exist only in the filter bank for a valve. It has 9 time constants, one of which
  // is 0.
  const auto at_once = columns(FilterKind::valve) / 9;
  EXPECT_EQ(columns(FilterKind::valve_and_finger),
            columns(FilterKind::valve) - at_once + columns(FilterKind::finger));
}

TEST(FilterBank, WeightedFiltersEqualColumnsTimesWeights) {
  const Record r = record();
  for (const FilterKind kind : {FilterKind::valve, FilterKind::finger, FilterKind::valve_and_finger}) {
    const Eigen::MatrixXd columns = filter_columns(r, r.drive_kpa, kind, 60);
    const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(columns.cols(), -1, 2);
    EXPECT_TRUE(weighted_filters(r, r.drive_kpa, kind, 60, weights).isApprox(columns * weights, 1e-9));
  }
}

TEST(FilterBank, BinnedColumnsAreBitForBitTheMeansOfTheColumns) {
  Record regular = record(), irregular = record();
  irregular.supply_kpa.assign(irregular.size(), 500.0);
  for (std::size_t i = 0; i < irregular.size(); ++i) {
    regular.drive_kpa[i] = 30 + 25 * std::sin(0.02 * static_cast<double>(i));
    irregular.drive_kpa[i] = regular.drive_kpa[i];
    irregular.supply_kpa[i] -= static_cast<double>(i % 7);
    irregular.time_s[i] += i % 3 == 0 ? 0 : 0.004;
    if (i > 0) irregular.duration_s[i] = irregular.time_s[i] - irregular.time_s[i - 1];
  }
  for (const Record& r : {regular, irregular}) {
    for (const double bin_s : {0.004, 0.1}) {  // some of the short bins contain no sample
      for (const FilterKind kind : {FilterKind::valve, FilterKind::finger, FilterKind::valve_and_finger}) {
        const Eigen::MatrixXd columns = filter_columns(r, r.drive_kpa, kind, 60);
        const Eigen::MatrixXd means = binned_filter_columns(r, r.drive_kpa, kind, 60, bin_s);
        ASSERT_EQ(means.cols(), columns.cols());
        std::size_t equal = 0, empty = 0;
        for (Eigen::Index c = 0; c < columns.cols(); ++c) {
          const std::vector<double> expected =
              binned(r, {columns.col(c).begin(), columns.col(c).end()}, bin_s);
          ASSERT_EQ(means.rows(), static_cast<Eigen::Index>(expected.size()));
          for (Eigen::Index b = 0; b < means.rows(); ++b) {
            const double mean = expected[static_cast<std::size_t>(b)];
            if (means(b, c) == mean) ++equal;
            if (std::isnan(means(b, c)) && std::isnan(mean)) ++empty;
          }
        }
        EXPECT_EQ(equal + empty, static_cast<std::size_t>(means.size()));
        EXPECT_GT(equal, 0U);
        EXPECT_EQ(empty > 0, bin_s < 0.01);
      }
    }
  }
}

TEST(Extension, SofteningWithZeroRangeActsAtTheLargestPressure) {
  Record r = record();
  for (std::size_t i = 0; i < r.size(); ++i) r.drive_kpa[i] = i < 10 ? 30 : 10;
  const std::vector<double> factor = softened({0.2, 0}, r, 60);
  EXPECT_DOUBLE_EQ(factor[5], 1.1);
  EXPECT_DOUBLE_EQ(factor[20], 1.1);
}

}  // namespace
}  // namespace softgrip::sysid::extension_test
