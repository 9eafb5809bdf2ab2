#include "sysid/changes/change_judge.h"

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sysid/changes/base_prediction.h"
#include "sysid/changes/healthy_runs.h"
#include "tests/sysid/changes/pressure_base.h"

namespace softgrip::sysid::change_judge_test {
namespace {

class ChangeJudge : public test::PressureBase {
 protected:
  [[nodiscard]] ChangeDiagnosis judged(const test::Finger& later) const {
    return judged_logs(test::logs_of(later, 5, true));
  }
  [[nodiscard]] ChangeDiagnosis judged_logs(const std::vector<Log>& later) const {
    ChangeDiagnosis diagnosis;
    const ChangeOptions options;
    judge_change(base_, true, pressure_records(later, false), options, diagnosis);
    return diagnosis;
  }

  /// Replaces the baseline model by a model with the same predictions for the slow ramps of the healthy logs
  /// but wrong predictions for steps.
  void make_wrong_for_steps() {
    // Two columns of the filter bank limit the difference between the command and the lagged command to 13 %
    // and 33 % of the largest pressure. They differ only if the command changes fast.
    constexpr Eigen::Index lags = 9, narrow = 10 * lags, wide = 11 * lags;
    ASSERT_GT(base_.filter_weights.size(), wide);
    base_.filter_weights(narrow) -= 0.2;
    base_.filter_weights(wide) += 0.2;
  }
};

TEST_F(ChangeJudge, FindsNoCauseInAnotherHealthyRun) {
  const ChangeDiagnosis diagnosis = judged({});
  EXPECT_TRUE(diagnosis.causes.empty());
  ASSERT_EQ(diagnosis.readings.size(), 1U);
  EXPECT_EQ(diagnosis.readings.front().judged, Judged::pressure);
  EXPECT_FALSE(diagnosis.readings.front().left_over);
}

TEST_F(ChangeJudge, FindsADelay) {
  const ChangeDiagnosis diagnosis = judged({.delay_s = 0.06});
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  EXPECT_EQ(diagnosis.causes.front().id, "transport_delay");
  EXPECT_EQ(diagnosis.causes.front().judged, Judged::pressure);
}

/// Adds a disturbance to the measured pressures that no cause describes: +height and -height in a random
/// order, each for 1 to 5 s.
std::vector<Log> disturbed(std::vector<Log> logs, double height_kpa) {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> length(50, 250);
  for (Log& log : logs) {
    double sign = 1;
    for (std::size_t i = 0, left = 0; i < log.size(); ++i, --left) {
      if (left == 0) {
        left = length(random);
        sign = random() % 2 == 0 ? 1 : -1;
      }
      log.pressure_kpa[i] += sign * height_kpa;
    }
  }
  return logs;
}

/// A delay is only a part of the change, so it may be a consequence of the unknown rest.
TEST_F(ChangeJudge, ACauseOfLessThanHalfOfTheChangeIsAPartialCause) {
  for (const double height_kpa : {0.0, 2.0}) {
    const ChangeDiagnosis diagnosis =
        judged_logs(disturbed(test::logs_of({.delay_s = 0.1}, 5, true), height_kpa));
    const JudgedChange& judged = diagnosis.readings.front();
    const auto& named = height_kpa > 0 ? diagnosis.partial : diagnosis.causes;
    const auto& others = height_kpa > 0 ? diagnosis.causes : diagnosis.partial;
    ASSERT_EQ(named.size(), 1U) << height_kpa << ' ' << share_explained(judged) << change_sentence(diagnosis);
    EXPECT_TRUE(others.empty());
    EXPECT_EQ(named.front().id, "transport_delay");
    EXPECT_EQ(share_explained(judged) < 0.5, height_kpa > 0) << share_explained(judged);
    EXPECT_EQ(judged.left_over, height_kpa > 0);
    const auto tried = std::ranges::find(judged.tried, "transport_delay", &TriedCause::id);
    ASSERT_NE(tried, judged.tried.end());
    EXPECT_EQ(tried->rejected, height_kpa > 0 ? "it explains less than half of the error of the change" : "");
  }
}

/// The first search names a cause and leaves an error, so a second search tries all causes again.
TEST_F(ChangeJudge, ANamedCauseHasNoReasonForARejection) {
  const ChangeDiagnosis diagnosis = judged({.delay_s = 0.06, .valve_lag_s = 0.1});
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  EXPECT_TRUE(diagnosis.readings.front().left_over);
  std::vector<std::string> accepted = diagnosis.causes.front().alternatives;
  accepted.push_back(diagnosis.causes.front().id);
  std::size_t tried_and_accepted = 0;
  for (const TriedCause& tried : diagnosis.readings.front().tried) {
    if (std::count(accepted.begin(), accepted.end(), tried.id) == 0) continue;
    EXPECT_EQ(tried.rejected, "") << tried.id;
    ++tried_and_accepted;
  }
  EXPECT_EQ(tried_and_accepted, accepted.size());
}

/// The table of tested causes shows the numbers of the first search. A reason from the second search
/// therefore names the cause that the first search found.
TEST_F(ChangeJudge, AReasonFromALaterSearchNamesTheCauseThatWasFoundFirst) {
  const ChangeDiagnosis diagnosis = judged({.delay_s = 0.06, .valve_lag_s = 0.1});
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  const JudgedChange& judged = diagnosis.readings.front();
  const std::string given = "with " + diagnosis.causes.front().id + ", ";
  std::size_t later = 0;
  for (const TriedCause& tried : judged.tried) {
    if (tried.rejected.starts_with(given)) ++later;
  }
  EXPECT_GT(later, 0U);
}

/// Returns logs with steps of the command. The pressure is the prediction of `base` with noise.
std::vector<Log> logs_with_steps(const Base& base) {
  std::vector<Log> logs = test::logs_of({}, 5, true);
  for (Log& log : logs) {
    std::vector<double> noise_kpa = log.pressure_kpa;
    for (std::size_t i = 0; i < log.size(); ++i) {
      noise_kpa[i] -= log.pressure_command_kpa[i];
      log.pressure_command_kpa[i] = i / 50 % 2 == 0 ? 0 : 50;
    }
    const std::vector<double> predicted_kpa =
        predict_base(base, pressure_records({log}, false).front(), Extension{});
    for (std::size_t i = 0; i < log.size(); ++i) log.pressure_kpa[i] = predicted_kpa[i] + noise_kpa[i];
  }
  return logs;
}

/// The healthy logs contain only ramps, so they do not show how fast the pressure follows a step. An error
/// after a step is therefore no evidence of a change.
TEST_F(ChangeJudge, PressuresAfterAnUnfamiliarCommandAreNotEvaluated) {
  const std::vector<Log> steps = logs_with_steps(base_);
  base_.alternatives = {};
  make_wrong_for_steps();
  const std::vector<Record> records = pressure_records(steps, false);
  EXPECT_GT(readings_of(base_, records, residuals_of(base_, records)).plain_rms({}), 0.5);
  const ChangeDiagnosis diagnosis = judged_logs(steps);
  EXPECT_TRUE(diagnosis.causes.empty()) << change_sentence(diagnosis);
  EXPECT_FALSE(diagnosis.readings.front().left_over);
  EXPECT_GT(diagnosis.readings.front().unevaluated_share, 0.9);
  // The steps are also a larger motion than the healthy ramps.
  ASSERT_EQ(diagnosis.warnings.size(), 2U);
  EXPECT_NE(diagnosis.warnings[0].find("are not evaluated"), std::string::npos);
  EXPECT_NE(diagnosis.warnings[1].find("the motion is larger"), std::string::npos);
  EXPECT_EQ(change_sentence(diagnosis).find("Unchanged:"), std::string::npos) << change_sentence(diagnosis);
}

TEST_F(ChangeJudge, PressuresAfterAFamiliarCommandAreEvaluated) {
  const ChangeDiagnosis diagnosis = judged({.delay_s = 0.06});
  EXPECT_LT(diagnosis.readings.front().unevaluated_share, 0.05);
}

/// The permitted error for an input like the healthy inputs does not depend on alternative models.
TEST_F(ChangeJudge, AChangeUnderAFamiliarInputIsFoundDespiteAlternatives) {
  const HealthyModel right = base_;
  base_.alternatives = {};
  const double allowed_mm = judged({.delay_s = 0.06}).readings.front().allowed_mm;
  make_wrong_for_steps();
  base_.alternatives = {right};
  const ChangeDiagnosis diagnosis = judged({.delay_s = 0.06});
  ASSERT_EQ(diagnosis.causes.size(), 1U) << change_sentence(diagnosis);
  EXPECT_EQ(diagnosis.causes.front().id, "transport_delay");
  EXPECT_NEAR(diagnosis.readings.front().allowed_mm, allowed_mm, 1e-3 * allowed_mm);
  EXPECT_TRUE(diagnosis.warnings.empty());
}

TEST_F(ChangeJudge, ModelsDisagreeMoreOnlyUnderAnUnfamiliarInput) {
  base_.alternatives = {base_};
  const std::vector<Record> steps = pressure_records(logs_with_steps(base_), false);
  const std::vector<Record> ramps = pressure_records(test::logs_of({}, 5, true), false);
  EXPECT_EQ(added_disagreement(base_, steps).loss, 0);
  const std::vector<std::vector<double>> right_kpa = residuals_of(base_, steps);
  make_wrong_for_steps();
  const Disagreement added = added_disagreement(base_, steps);
  EXPECT_GT(added.loss, 1);
  // The models agree about the two healthy logs. For the steps, their disagreement is as uncertain as the
  // error of a single run. The permitted error is 9.3 times the error of one run, and 7.0 times that of two.
  const LaterReadings differing = readings_of(base_, steps, minus(residuals_of(base_, steps), right_kpa));
  const double loss = per_bin(differing, differing.white({}));
  EXPECT_NEAR(added.loss, 4.0 / 3 * loss, 0.01 * loss);
  EXPECT_LT(added_disagreement(base_, ramps).loss, 1e-3);
}

/// A difference between the predictions of two models that also occurs for the healthy logs is no sign of an
/// unfamiliar input.
TEST_F(ChangeJudge, ADisagreementAboutHealthyLogsIsSubtracted) {
  Base other = base_;
  // The two columns contain different lags of the command, so the models predict ramps differently.
  other.filter_weights(2) += 0.5;
  other.filter_weights(4) -= 0.5;
  const auto own = residuals_of(base_, base_.records), others = residuals_of(other, base_.records);
  for (std::size_t r = 0; r < own.size(); ++r) {
    std::vector<double> difference = others[r];
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= own[r][i];
    const std::vector<double> bins = binned(base_.records[r], difference, base_.bin_s);
    for (std::size_t b = 0; b < bins.size(); ++b) other.left[r][b] += bins[b];
  }
  const std::vector<Record> ramps = pressure_records(test::logs_of({}, 5, true), false);
  base_.alternatives = {other};
  EXPECT_EQ(added_disagreement(base_, ramps).loss, 0);
  other.left = base_.left;  // the models agree about the healthy logs
  base_.alternatives = {other};
  EXPECT_GT(added_disagreement(base_, ramps).loss, 0);
}

/// A prediction that is farther from the other one than the span of the readings is no evidence.
TEST_F(ChangeJudge, AnAlternativeThatDivergesIsIgnored) {
  Base other = base_;
  other.filter_weights *= 1000;
  base_.alternatives = {other};
  const std::vector<Record> ramps = pressure_records(test::logs_of({}, 5, true), false);
  EXPECT_EQ(added_disagreement(base_, ramps).loss, 0);
}

/// A weight changes the zero offset of a linear finger and nothing else. The response of this finger
/// decreases with the displacement, so a weight also changes the shape of its readings.
TEST(Weight, OnANonlinearFingerIsNamedWithItsPressure) {
  const double bend_per_mm = 0.05;
  const Base base = fit_base(make_records(test::logs_of({.bend_per_mm = bend_per_mm}, 1), {}),
                             Judged::displacement, Drive::command, {});
  ChangeDiagnosis diagnosis;
  judge_change(base, false, make_records(test::logs_of({.bend_per_mm = bend_per_mm, .weight_kpa = 8}, 5), {}),
               {}, diagnosis);
  ASSERT_EQ(diagnosis.causes.size(), 1U) << change_sentence(diagnosis);
  EXPECT_EQ(diagnosis.causes.front().id, "payload");
  const std::vector<std::string>& alternatives = diagnosis.causes.front().alternatives;
  EXPECT_EQ(std::count(alternatives.begin(), alternatives.end(), "payload"), 0);
  EXPECT_EQ(diagnosis.causes.front().size.unit, "kPa");
  EXPECT_NEAR(diagnosis.causes.front().size.value, 8, 1.5);
}

TEST(UnusualZero, IsStatedIfNoHealthyRunHasSuchAZero) {
  const Base base =
      fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  ASSERT_TRUE(base.units.are_runs());
  const auto warnings = [&](double zero_mm) {
    ChangeDiagnosis diagnosis;
    judge_change(base, false, make_records(test::logs_of({.zero_mm = zero_mm}, 5), {}), {}, diagnosis);
    EXPECT_TRUE(diagnosis.causes.empty());
    return static_cast<int>(std::count_if(
        diagnosis.warnings.begin(), diagnosis.warnings.end(),
        [](const std::string& text) { return text.find("zero in the later logs") != std::string::npos; }));
  };
  EXPECT_EQ(warnings(-3), 1);
  EXPECT_EQ(warnings(0), 0);
}

TEST(UnusualGain, IsStatedIfTheSpreadOfTheHealthyLogsContainsIt) {
  Base base = fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  base.gain_spread = 0.1;
  base.free_gain = 0.3;
  const auto warnings = [&](double gain) {
    ChangeDiagnosis diagnosis;
    judge_change(base, false, make_records(test::logs_of({.gain = gain}, 5), {}), {}, diagnosis);
    EXPECT_TRUE(diagnosis.causes.empty());
    return static_cast<int>(std::count_if(
        diagnosis.warnings.begin(), diagnosis.warnings.end(),
        [](const std::string& text) { return text.find("is not significant") != std::string::npos; }));
  };
  EXPECT_EQ(warnings(0.17), 1);
  EXPECT_EQ(warnings(0.2), 0);
}

}  // namespace
}  // namespace softgrip::sysid::change_judge_test
