// Tests the search on simulated data without a cause. False alarms must be rare, and their error reductions
// must be smaller than the error reduction of a real cause.

#include "sysid/diagnosis/search/null_calibration.h"

#include <gtest/gtest.h>

#include "model/signals.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/search/selection.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::null_calibration_test {
namespace {

constexpr std::size_t few = 4;

struct Searched {
  SearchData data;
  StructureFit base;
  Division division;
};

/// Simulates two logs with the model zhang2025 and a backlash of `backlash_mm`. Returns the data that a
/// search for causes needs.
Searched searched(double backlash_mm) {
  const model::Model given = loaded("zhang2025");
  model::Model truth = given;
  if (backlash_mm > 0)
    truth = model::with_block(given, {find_cause("backlash")->forms.front().type, {backlash_mm}});
  const std::vector<Log> logs{simulated(truth, model::SignalName::tp1, 25, 0.04, 1),
                              simulated(truth, model::SignalName::sp2, 25, 0.04, 2)};
  Searched s;
  s.data = make_search_data(make_records(logs, {}), given);
  s.base = fit_structure(s.data.records, {}, s.data.given);
  s.division = divide(s.data.records, 8);
  return s;
}

NullOptions options(std::uint64_t seed) {
  NullOptions options;
  options.campaigns = few;
  options.seed = seed;
  return options;
}

TEST(NullCalibration, NoNullReachesTheErrorReductionOfARealCause) {
  const Searched s = searched(1.5);
  Selection selection =
      select_causes(s.data, s.base, measured_noise_mm(s.data.records), s.division, SelectionOptions{});
  ASSERT_FALSE(selection.chosen.empty());
  const double gain = gain_percent(selection.base_losses, selection.extended_losses, 1).value;
  ASSERT_GT(gain, 30);
  const NullCalibration nulls = calibrate_on_nulls(s.data, s.base, gain, s.division, options(5));
  EXPECT_EQ(nulls.gain_percent, gain);
  EXPECT_EQ(nulls.campaigns, few);
  EXPECT_LT(nulls.largest_gain_percent, gain);
  EXPECT_DOUBLE_EQ(nulls.p_value, 1.0 / (few + 1));
}

TEST(NullCalibration, ZeroErrorReductionHasAPValueOfOne) {
  const Searched s = searched(0);
  EXPECT_DOUBLE_EQ(calibrate_on_nulls(s.data, s.base, 0, s.division, options(5)).p_value, 1);
}

TEST(NullCalibration, NoCauseIsNamedForWhiteNoise) {
  const Searched s = searched(0);
  EXPECT_EQ(calibrate_on_nulls(s.data, s.base, 1, s.division, options(11)).named, 0U);
}

TEST(NullCalibration, ResultIsIndependentOfTheThreadCount) {
  Searched s = searched(1.5);
  NullOptions two = options(2);
  two.campaigns = 2;
  s.data.threads = 1;
  const NullCalibration alone = calibrate_on_nulls(s.data, s.base, 3, s.division, two);
  s.data.threads = 2;
  const NullCalibration together = calibrate_on_nulls(s.data, s.base, 3, s.division, two);
  EXPECT_EQ(alone.named, together.named);
  EXPECT_EQ(alone.largest_gain_percent, together.largest_gain_percent);
}

}  // namespace
}  // namespace softgrip::sysid::null_calibration_test
