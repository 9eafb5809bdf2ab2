// Tests the scan of start points. The scan evaluates each start point with one linearised step. If the model
// structure responds linearly, the result must be exact. If the data contain a hidden cause, the start point
// nearest to its true parameters must be ranked first.

#include "sysid/diagnosis/search/scan.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "model/catalogue.h"
#include "sysid/diagnosis/search/search.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::scan_test {
namespace {

constexpr double noise_mm = 0.04;

std::vector<Record> records_of(const model::Model& truth) {
  const std::vector<Log> logs{simulated(truth, model::SignalName::tp1, 40, noise_mm, 1),
                              simulated(truth, model::SignalName::sp2, 40, noise_mm, 2)};
  return make_records(logs, {});
}

model::BlockSpec block(const char* id, std::vector<double> values) {
  return {find_cause(id)->forms.front().type, std::move(values)};
}

class Scanned : public ::testing::Test {
 protected:
  [[nodiscard]] Scan scan_of(const model::Model& truth, const model::Model& place) {
    records_ = records_of(truth);
    return {records_, {}, {place, rest_starts(place, records_)}};
  }
  std::vector<Record> records_;
};

TEST_F(Scanned, TrueBlockReducesTheErrorToTheNoise) {
  const model::Model base = loaded("zhang2025");
  const model::BlockSpec hidden = block("backlash", {1.2});
  const Scan scan = scan_of(model::with_block(base, hidden), base);
  ASSERT_TRUE(scan.usable());
  const model::Model truth = model::with_block(base, hidden);
  const double noise_alone =
      evaluate_structure(records_, {}, {truth, rest_starts(truth, records_)}).mean_square_mm2;
  EXPECT_NEAR(std::sqrt(scan.mean_square_with(hidden)), std::sqrt(noise_alone), 0.01 * noise_mm);
  EXPECT_GT(std::sqrt(scan.mean_square_with(block("backlash", {0.05}))), 3 * noise_mm);
}

TEST_F(Scanned, SmallParameterErrorIsLargelyCompensated) {
  const model::Model base = loaded("zhang2025");
  const Scan drifting = scan_of(model::with_block(base, block("sensor_saturation", {-10000, 14})), base);
  ASSERT_TRUE(drifting.usable());
  EXPECT_LT(drifting.mean_square_with(block("sensor_saturation", {-10000, 13.5})),
            0.3 * drifting.mean_square_with(block("sensor_saturation", {-10000, 10000})));
}

TEST_F(Scanned, PredictedErrorIsIndependentOfABaseParameter) {
  // A refit of the model structure compensates for a change of alpha. The predicted error must therefore not
  // depend on alpha.
  const model::Model base = loaded("zhang2025");
  model::Model moved = base;
  moved.blocks[0].values[0] *= 1.001;
  const Scan at_truth = scan_of(base, base);
  const double there = at_truth.mean_square_with(block("backlash", {0.0}));
  const Scan beside = scan_of(base, moved);
  EXPECT_NEAR(std::sqrt(beside.mean_square_with(block("backlash", {0.0}))), std::sqrt(there), 1e-4);
}

TEST_F(Scanned, InvalidBlockHasAnInfiniteError) {
  const model::Model base = loaded("zhang2025");
  const Scan scan = scan_of(base, base);
  EXPECT_TRUE(std::isinf(scan.mean_square_with(block("backlash", {-1}))));
}

TEST(BestStarts, DelayNearestToTheTrueDelayComesFirst) {
  const model::Model given = loaded("zhang2025");
  const model::Model truth = model::with_block(given, block("transport_delay", {0.11}));
  const SearchData data = make_search_data(records_of(truth), given);
  std::vector<Scan> scans;
  scans.emplace_back(data.thinned, std::vector<Cause>{}, data.given);
  const auto points = best_starts(scans, *find_cause("transport_delay"), data.scales, 2);
  ASSERT_EQ(points.size(), 2U);
  const auto at = model::position_of(points.front().model, find_cause("transport_delay")->forms.front().type);
  EXPECT_NEAR(points.front().model.blocks[*at].values[0], 0.1, 1e-12);
}

// Of the forms of this cause, one has more parameters and therefore the smallest predicted error at every
// start point. Nevertheless, the result must contain start points of every form and of every scan.
TEST(BestStarts, ContainEveryFormOfACauseAndEveryScan) {
  const model::Model given = loaded("zhang2025");
  const SearchData data = make_search_data(records_of(model::with_block(given, block("ageing", {4}))), given);
  model::Model other = given;
  other.blocks[0].values[0] *= 1.05;
  std::vector<Scan> scans;
  scans.emplace_back(data.thinned, std::vector<Cause>{}, data.given);
  scans.emplace_back(data.thinned, std::vector<Cause>{}, FitPoint{other, rest_starts(other, data.thinned)});
  const auto points = best_starts(scans, *find_cause("ageing"), data.scales, 1);
  std::size_t elsewhere = 0;
  std::set<std::string> forms;
  for (const FitPoint& point : points) {
    const model::Model& extended = point.model;
    forms.emplace(
        model::catalogue()[extended.blocks[*position_of(extended, *find_cause("ageing"))].type].info.id);
    elsewhere += extended.blocks[0].values[0] == other.blocks[0].values[0] ? 1U : 0U;
  }
  EXPECT_EQ(forms, (std::set<std::string>{"ageing", "running_in", "wear"}));
  EXPECT_GE(elsewhere, 1U);
  EXPECT_LT(elsewhere, points.size());
  EXPECT_LE(points.size(), 4U);
  const FitPoint last = best_starts(scans, *find_cause("sensor_drift"), data.scales, 1).back();
  const Cause drift = *find_cause("sensor_drift");
  EXPECT_TRUE(form_of(drift, last.model.blocks[*position_of(last.model, drift)]).free_form);
}

}  // namespace
}  // namespace softgrip::sysid::scan_test
