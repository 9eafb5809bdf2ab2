#include "sysid/changes/filter_fit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sysid/fitting/start_estimate.h"

namespace softgrip::sysid::filter_fit_test {
namespace {

constexpr double bin_s = 0.1;

Record waving() {
  Record record;
  record.name = "waving";
  for (int i = 0; i < 1500; ++i) {
    const double t = 0.02 * i;
    record.time_s.push_back(t);
    record.duration_s.push_back(i > 0 ? 0.02 : 0);
    record.drive_kpa.push_back(12 - 10 * std::cos(t) * std::cos(0.3 * t));
    record.reading_mm.push_back(0);
  }
  record.sample_time_s = 0.02;
  record.largest_kpa = 22;
  return record;
}

/// Returns a residual that is the sum of two parts. The first part is `share` times the command after a
/// first-order lag of 0.5 s. The second part does not depend on the command.
Binned left_of(const Record& record, double share) {
  const std::vector<double> drive = binned(record, lagged(record, record.drive_kpa, 0.5), bin_s);
  Binned left{{}};
  for (std::size_t b = 0; b < drive.size(); ++b)
    left[0].push_back(share * drive[b] + 0.01 * std::sin(0.7 * static_cast<double>(b * b)));
  return left;
}

/// Returns the filter banks for residuals of `runs` equal runs.
/// @param models  residual of each model in one run.
std::vector<FittedFilters> fitted(const std::vector<Binned>& models, std::size_t runs = 2,
                                  FilterKind kind = FilterKind::finger) {
  const std::vector<Record> records(runs, waving());
  const Units units(records);
  std::vector<LeftByUnit> left;
  for (const Binned& model : models) left.emplace_back(units.count() + 1, Binned(runs, model.front()));
  return fit_filters(records, units, kind, bin_s, 22, left, 1);
}

TEST(FilterFit, ExplainsAResidualThatFollowsTheDrive) {
  const FittedFilters filters = fitted({left_of(waving(), 0.1)})[0];
  EXPECT_GT(filters.weights.size(), 0);
  EXPECT_LT(filters.left_mm, 0.02);
  EXPECT_GT(filters.left_mm, 0.005);
}

TEST(FilterFit, OneRunShowsNoFilterBankOfAFinger) {
  const std::vector<Binned> residual{left_of(waving(), 0.1)};
  EXPECT_EQ(fitted(residual, 1)[0].weights.size(), 0);
  EXPECT_GT(fitted(residual, 1, FilterKind::valve)[0].weights.size(), 0);
  EXPECT_GT(fitted(residual, 2)[0].weights.size(), 0);
}

TEST(FilterFit, ResidualIndependentOfTheDriveGetsNoFilters) {
  const FittedFilters filters = fitted({left_of(waving(), 0)}, 1, FilterKind::valve)[0];
  EXPECT_EQ(filters.weights.size(), 0);
  const Binned model = left_of(waving(), 0);
  const auto begin = static_cast<std::size_t>(begin_s(waving()) / bin_s);
  for (std::size_t b = 0; b < model[0].size(); ++b) {
    if (b < begin)
      EXPECT_TRUE(std::isnan(filters.left[0][b])) << b;
    else
      EXPECT_EQ(filters.left[0][b], model[0][b]) << b;
  }
}

/// The error of a left-out cross-validation unit must be computed from the residual of the model that was
/// fitted without this unit.
TEST(FilterFit, EachUnitIsScoredByAModelFittedWithoutThatUnit) {
  const std::vector<Record> records{waving()};
  const Units units(records);
  const Binned whole = left_of(waving(), 0);
  LeftByUnit left;
  for (std::size_t fitted_without = 0; fitted_without <= units.count(); ++fitted_without) {
    left.push_back(whole);
    for (double& v : left.back()[0]) v *= 2 + static_cast<double>(fitted_without);
  }
  const FittedFilters filters = fit_filters(records, units, FilterKind::finger, bin_s, 22, {left}, 1).front();
  ASSERT_EQ(filters.weights.size(), 0);
  std::size_t judged = 0;
  for (std::size_t b = 0; b < whole[0].size(); ++b) {
    if (std::isnan(filters.left[0][b])) continue;
    EXPECT_EQ(filters.left[0][b], left[units.unit_of(0, (static_cast<double>(b) + 0.5) * bin_s)][0][b]) << b;
    ++judged;
  }
  EXPECT_GT(judged, whole[0].size() / 2);
}

TEST(FilterFit, JointFitEqualsTheSeparateFitOfEachModel) {
  const std::vector<Binned> left{left_of(waving(), 0.1), left_of(waving(), -0.2), left_of(waving(), 0.3)};
  const std::vector<FittedFilters> together = fitted(left);
  ASSERT_EQ(together.size(), 3U);
  for (std::size_t m = 0; m < 3; ++m) {
    const FittedFilters alone = fitted({left[m]})[0];
    EXPECT_EQ(together[m].left_mm, alone.left_mm) << m;
    EXPECT_EQ(together[m].weights, alone.weights) << m;
  }
}

TEST(FilterFit, NonFiniteResidualGivesAnInfiniteError) {
  std::vector<Binned> left{left_of(waving(), 0.1), left_of(waving(), 0.1)};
  left[1][0][40] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<FittedFilters> fits = fitted(left);
  EXPECT_LT(fits[0].left_mm, 0.02);
  EXPECT_TRUE(std::isinf(fits[1].left_mm));
}

}  // namespace
}  // namespace softgrip::sysid::filter_fit_test
