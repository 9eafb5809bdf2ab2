#include "sysid/diagnosis/verdict/conclusion.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sysid/diagnosis/search/holdout.h"
#include "tests/sysid/diagnosis/campaign.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::conclusion_test {
namespace {

TEST(Conclusion, OutliersPermitAnUncorrelatedUnexplainedError) {
  const std::vector<Log> logs;
  const model::Model given;
  const DiagnosisOptions options;
  const SearchData data;
  Diagnosis diagnosis;
  diagnosis.noise_mm = 0.1;
  const Conclusion conclusion(logs, given, options, data, diagnosis);
  Selection selection;
  selection.left.excess_mm = 0.05;
  EXPECT_FALSE(conclusion.leaves_too_much(selection)) << "no unexplained error is present";
  selection.left.present = true;
  EXPECT_TRUE(conclusion.leaves_too_much(selection));
  EXPECT_FALSE(conclusion.left_by_outliers(selection.left));
  diagnosis.outliers.present = true;
  EXPECT_TRUE(conclusion.left_by_outliers(selection.left));
  EXPECT_FALSE(conclusion.leaves_too_much(selection)) << "outliers that were not found leave this error";
  selection.left.slow_correlation = 0.5;
  EXPECT_TRUE(conclusion.leaves_too_much(selection)) << "the error is correlated from sample to sample";
}

TEST(Conclusion, SimulatedDataRejectOnlyTheCausesOfTheSearch) {
  const model::Model given = loaded("zhang2025");
  const model::BlockSpec play{find_cause("backlash")->forms.front().type, {1.5}};
  const std::vector<Log> logs{simulated(model::with_block(given, play), model::SignalName::tp1, 25, 0.04, 1)};
  const SearchData data = make_search_data(make_records(logs, {}), given);
  const Division division = divide(data.records, 8);
  Diagnosis d;
  d.records = data.records;
  d.noise_mm = 0.04;
  d.as_given = d.recalibrated = fit_structure(data.records, {}, data.given);
  Selection selection = selection_from(d.recalibrated, losses_of(d.recalibrated, division), d.noise_mm, 0);
  FitPoint point = data.given;
  point.model = model::with_block(given, play);
  const Cause backlash = *find_cause("backlash");
  selection.extended = fit_structure(data.records, {backlash}, point);
  selection.extended_losses = losses_of(selection.extended, division);
  selection.left = {};
  selection.chosen = {chosen_cause(backlash, selection.base_losses, selection.extended_losses, 1)};
  d.lead = ReadingLead{0.15, {0.14, 0.16}};
  const DiagnosisOptions options;
  Conclusion conclusion(logs, given, options, data, d);
  conclusion.drive_is_shifted({9, BlockLosses(selection.base_losses.size(), 4), selection.base_losses});
  conclusion.measure(selection, division);
  NullOptions nulls;
  nulls.campaigns = 1;
  conclusion.calibrate(selection, division, nulls);
  const double searched = gain_percent(selection.base_losses, selection.extended_losses, 1).value;
  EXPECT_DOUBLE_EQ(d.null_calibration->gain_percent, searched) << "a shift of the drive does not count";
  EXPECT_GT(d.gain.value, searched + 1) << "the reduction of the diagnosis includes the shift of the drive";
  d.null_calibration = NullCalibration{.campaigns = 19, .named = 19, .p_value = 0.5};
  conclusion.name(selection);
  conclusion.conclude(selection, division);
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes.front().cause.id, "clock_offset");
  ASSERT_EQ(d.partial.size(), 1U);
  EXPECT_EQ(d.partial.front().cause.id, "backlash");
  EXPECT_EQ(d.verdict, Verdict::partly_explained);
  EXPECT_FALSE(is_extended(d));
  EXPECT_FALSE(position_of(d.extended_model, backlash));
  EXPECT_DOUBLE_EQ(d.extended_rmse_mm, rmse_mm(selection.base_losses));
  EXPECT_DOUBLE_EQ(d.recalibrated_rmse_mm, 2);
  for (const RunError& run : d.runs) EXPECT_EQ(run.extended, run.recalibrated);
}

/// Returns the diagnosis that adopts a structure whose unexplained error is `share` times that of the base.
Diagnosis adopted(double share) {
  const model::Model given = loaded("zhang2025");
  const std::vector<Log> logs{simulated(given, model::SignalName::tp1, 25, 0.3, 1)};
  const SearchData data = make_search_data(make_records(logs, {}), given);
  const Division division = divide(data.records, 8);
  Diagnosis d;
  d.records = data.records;
  d.noise_mm = 0.01;
  d.as_given = fit_structure(data.records, {}, data.given);
  const Selection selection = selection_from(d.as_given, losses_of(d.as_given, division), d.noise_mm, 0);
  BaseFindings base;
  base.fit = selection.base;
  for (std::vector<double>& residual : base.fit.residual_mm) {
    for (double& each : residual) each *= std::sqrt(share);
  }
  base.losses = selection.base_losses;
  NamedCause backlash;
  backlash.cause = *find_cause("backlash");
  base.named = {backlash};
  const DiagnosisOptions options;
  Conclusion(logs, given, options, data, d).adopt(base, selection);
  return d;
}

TEST(Conclusion, AStructureThatExplainsLittleNamesNoComponent) {
  const Diagnosis little = adopted(0.9), much = adopted(0.5);
  EXPECT_EQ(little.verdict, Verdict::unexplained);
  EXPECT_TRUE(little.causes.empty());
  ASSERT_EQ(little.partial.size(), 1U);
  EXPECT_EQ(little.partial.front().cause.id, "backlash");
  EXPECT_EQ(much.verdict, Verdict::partly_explained);
  EXPECT_EQ(much.causes.size(), 1U);
  EXPECT_TRUE(much.partial.empty());
}

BlockLosses losses(const Division& division, double first_mm2, double other_mm2) {
  BlockLosses each;
  for (const Block& block : division.blocks) each.push_back(block.fold == 0 ? first_mm2 : other_mm2);
  return each;
}

TEST(RunErrors, AreTheErrorsOfEachRun) {
  const std::vector<Record> records = known_campaign(2);
  const Division by_unit = divide_by_unit(records);
  const std::vector<RunError> runs =
      run_errors(records, by_unit, losses(by_unit, 4, 9), losses(by_unit, 1, 4), losses(by_unit, 0.25, 1));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].run, "log_1");
  EXPECT_EQ(runs[1].run, "log_2");
  EXPECT_DOUBLE_EQ(runs[0].given, 2);
  EXPECT_DOUBLE_EQ(runs[1].given, 3);
  EXPECT_DOUBLE_EQ(runs[0].recalibrated, 1);
  EXPECT_DOUBLE_EQ(runs[1].recalibrated, 2);
  EXPECT_DOUBLE_EQ(runs[0].extended, 0.5);
  EXPECT_DOUBLE_EQ(runs[1].extended, 1);
}

TEST(RunErrors, SingleRunGivesTheErrorsOfBothHalves) {
  const std::vector<Record> records = known_campaign(1);
  const Division by_unit = divide_by_unit(records);
  const BlockLosses given = losses(by_unit, 4, 9);
  const std::vector<RunError> halves = run_errors(records, by_unit, given, given, given);
  ASSERT_EQ(halves.size(), 2U);
  EXPECT_EQ(halves[0].run, "first half");
  EXPECT_EQ(halves[1].run, "second half");
  EXPECT_DOUBLE_EQ(halves[0].given, 2);
  EXPECT_DOUBLE_EQ(halves[1].given, 3);
}

}  // namespace
}  // namespace softgrip::sysid::conclusion_test
