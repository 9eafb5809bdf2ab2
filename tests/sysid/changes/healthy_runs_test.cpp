#include "sysid/changes/healthy_runs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
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

TEST(AddedDisagreement, DoesNotDependOnTheReadings) {
  const Base base =
      fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  ASSERT_FALSE(base.alternatives.empty());
  Log log = test::log_of({}, 7);
  // The models disagree, because the pressures are twice as large as in the healthy logs.
  for (double& kpa : log.pressure_command_kpa) kpa *= 2;
  // A prediction of such a record usually begins in the state that its first readings show.
  std::vector<Record> later = make_records({log}, {.start = Start::unknown});
  const Disagreement before = added_disagreement(base, later);
  EXPECT_GT(before.mean_square, 0.01);
  // This change of the readings looks like unsettled creep.
  for (std::size_t i = 0; i < later[0].size(); ++i)
    later[0].reading_mm[i] += 5 * std::exp(-later[0].time_s[i] / 2);
  const Disagreement creeping = added_disagreement(base, later);
  EXPECT_NEAR(creeping.mean_square, before.mean_square, 1e-9);
  EXPECT_NEAR(creeping.loss, before.loss, 1e-6);
}

/// Returns a record of the test finger whose commands are multiplied by `factor`.
std::vector<Record> later_with(double factor) {
  Log log = test::log_of({}, 1);
  for (double& kpa : log.pressure_command_kpa) kpa *= factor;
  return make_records({log}, {});
}

TEST(AddedByMotion, ErrorOfTheModelIncreasesInProportionToTheMotion) {
  Base base = fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  const double noise_mm2 = healthy_readings(base).plain_rms({}) * healthy_readings(base).plain_rms({});
  EXPECT_LT(added_by_motion(base, later_with(2)).mean_square, noise_mm2)
      << "the model has hardly any error, and the noise does not increase";
  for (std::vector<double>& record : base.left) {
    for (double& left_mm : record) left_mm *= 20;
  }
  const double error_mm2 = 400 * noise_mm2;
  const Disagreement same = added_by_motion(base, later_with(1)),
                     twice = added_by_motion(base, later_with(2)),
                     half = added_by_motion(base, later_with(0.5));
  EXPECT_LT(same.mean_square, 0.3 * error_mm2);
  // Twice the motion has four times the mean square.
  EXPECT_NEAR(twice.mean_square - same.mean_square, 3 * error_mm2, 0.6 * error_mm2);
  EXPECT_GT(twice.loss, same.loss);
  EXPECT_EQ(half.mean_square, 0);
  EXPECT_EQ(half.loss, 0);
}

TEST(RunSpreadOfSixRuns, AdmitsAChangeIfOneErrorExceedsItsBoundOrBothTheHealthyErrors) {
  std::vector<Log> logs;
  for (const unsigned seed : {1U, 11U, 21U}) {
    for (Log& log : test::logs_of({}, seed, true)) logs.push_back(std::move(log));
  }
  const Base base = fit_base(pressure_records(logs, false), Judged::pressure, Drive::command, {});
  const LaterReadings all = healthy_readings(base);
  std::vector<HealthyFits> healthy;
  std::vector<double> rms, losses;
  for (std::size_t unit = 0; unit < base.units.count(); ++unit) {
    healthy.push_back({all.only(base.units, unit), {}});
    rms.push_back(healthy.back().readings.plain_rms({}));
    losses.push_back(per_bin(healthy.back().readings, healthy.back().readings.white({})));
  }
  const std::size_t runs = base.units.runs();
  ASSERT_GE(runs, 6U);
  const RunSpread spread(healthy, runs);
  const double worst_rms = *std::max_element(rms.begin(), rms.end());
  const double worst_loss = *std::max_element(losses.begin(), losses.end());
  const double rms_bound = prediction_bound(rms), loss_bound = prediction_bound(losses);
  ASSERT_FALSE(spread.is_exceeded(1.005 * rms_bound, 1.005 * loss_bound));
  ASSERT_GT(rms_bound, 1.01 * worst_rms);
  ASSERT_GT(loss_bound, 1.01 * worst_loss);
  EXPECT_TRUE(spread.admits_a_change(1.005 * rms_bound, worst_loss));
  EXPECT_TRUE(spread.admits_a_change(worst_rms, 1.005 * loss_bound));
  EXPECT_FALSE(spread.admits_a_change(0.995 * rms_bound, worst_loss)) << "only one error is large";
  EXPECT_FALSE(spread.admits_a_change(worst_rms, 0.995 * loss_bound)) << "only one error is large";
  EXPECT_TRUE(spread.admits_a_change(1.005 * worst_rms, 1.005 * worst_loss)) << "both errors are large";
  const RunSpread one_run(healthy, 1);
  EXPECT_FALSE(one_run.admits_a_change(1.005 * rms_bound, 1.005 * loss_bound)) << "the parts of one run";
}

TEST(PredictionBound, IsExceededByTwoAndAHalfPercentOfSimilarRuns) {
  std::mt19937 random(2);
  std::lognormal_distribution<double> error(-1, 0.3);
  for (const std::size_t runs : {3U, 6U}) {
    int exceeded = 0;
    constexpr int sets = 8000;
    for (int i = 0; i < sets; ++i) {
      std::vector<double> errors(runs);
      std::generate(errors.begin(), errors.end(), [&] { return error(random); });
      exceeded += error(random) > prediction_bound(errors) ? 1 : 0;
    }
    EXPECT_NEAR(exceeded / static_cast<double>(sets), 0.025, 0.006) << runs << " runs, seed 2";
  }
}

TEST(PredictionBound, OfEqualErrorsIsTheirValue) {
  EXPECT_NEAR(prediction_bound({0.2, 0.2, 0.2}), 0.2, 1e-9);
}

}  // namespace
}  // namespace softgrip::sysid::healthy_runs_test
