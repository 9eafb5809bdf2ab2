// Tests of changes that have several causes at the same time.

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "sysid/changes/base.h"
#include "sysid/changes/change_judge.h"
#include "sysid/changes/change_report.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::several_causes_test {
namespace {

const ChangeCause* cause_named(const ChangeDiagnosis& d, std::string_view id) {
  const auto found = std::find_if(d.causes.begin(), d.causes.end(), [&](const ChangeCause& c) {
    return c.id == id || std::count(c.alternatives.begin(), c.alternatives.end(), id) > 0;
  });
  return found == d.causes.end() ? nullptr : &*found;
}

/// Adds an error of 20 mm to 0.5 % of the readings.
std::vector<Log> with_wrong_samples(std::vector<Log> logs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (Log& log : logs) {
    for (double& mm : log.displacement_mm) {
      if (uniform(random) < 0.005) mm += uniform(random) < 0.5 ? 20 : -20;
    }
  }
  return logs;
}

/// The error reduction by the wrong samples is relative to the noise of single readings, and the error
/// reduction by the gain is relative to the error of the baseline model. The two numbers cannot be compared.
TEST(SeveralCauses, AChangeOfTheGainIsNamedTogetherWithWrongSamples) {
  const auto d =
      diagnose_change(test::logs_of({}, 1), with_wrong_samples(test::logs_of({.gain = 0.2 * 1.03}, 5)));
  ASSERT_TRUE(d) << d.error();
  const ChangeCause* const wrong = cause_named(*d, "outliers");
  ASSERT_NE(wrong, nullptr) << change_sentence(*d);
  EXPECT_FALSE(wrong->gain_interval);
  const ChangeCause* const gain = cause_named(*d, "ageing");
  ASSERT_NE(gain, nullptr) << change_sentence(*d);
  EXPECT_TRUE(gain->gain_interval);
  EXPECT_LT(gain->gain, 0.02 * wrong->gain);
}

TEST(SeveralCauses, AChangeOfTheFingerIsNamedTogetherWithAChangeOfTheValve) {
  const auto d = diagnose_change(test::logs_of({}, 1, true),
                                 test::logs_of({.gain = 0.2 * 0.955, .valve_lag_s = 0.15}, 5, true));
  ASSERT_TRUE(d) << d.error();
  const ChangeCause* const lag = cause_named(*d, "valve_lag");
  ASSERT_NE(lag, nullptr) << change_sentence(*d);
  const ChangeCause* const gain = cause_named(*d, "ageing");
  ASSERT_NE(gain, nullptr) << change_sentence(*d);
  EXPECT_LT(gain->gain, 0.02 * lag->gain);
}

/// Returns the number of causes in the displacement of a finger whose gain has changed.
/// @param before  result for the pressure.
std::size_t causes_of_gain(double gain, ChangeDiagnosis before) {
  const Base base =
      fit_base(make_records(test::logs_of({}, 1), {}), Judged::displacement, Drive::command, {});
  const std::size_t causes = before.causes.size();
  judge_change(base, true, make_records(test::logs_of({.gain = gain}, 5), {}), {}, before);
  return before.causes.size() - causes;
}

TEST(SeveralCauses, ASmallErrorOfTheFingerCanBeAConsequenceOfThePressure) {
  constexpr double slightly = 0.2 * 1.035, clearly = 0.2 * 1.1;
  EXPECT_EQ(causes_of_gain(slightly, {}), 1U);
  ChangeDiagnosis named;
  named.causes.emplace_back();
  named.causes.back().judged = Judged::pressure;
  EXPECT_EQ(causes_of_gain(slightly, named), 0U);
  EXPECT_EQ(causes_of_gain(clearly, named), 1U);
  ChangeDiagnosis unexplained;
  unexplained.readings.emplace_back();
  unexplained.readings.back().judged = Judged::pressure;
  EXPECT_EQ(causes_of_gain(slightly, unexplained), 1U);
  unexplained.readings.back().left_over = true;
  EXPECT_EQ(causes_of_gain(slightly, unexplained), 0U);
}

}  // namespace
}  // namespace softgrip::sysid::several_causes_test
