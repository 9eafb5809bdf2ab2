#include "sysid/changes/base_candidate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::base_candidate_test {
namespace {

constexpr double finger_bin_s = 0.05;

double rms_of_run(const std::vector<double>& run) {
  double sum = 0, count = 0;
  for (const double value : run) {
    if (!std::isfinite(value)) continue;
    sum += value * value;
    count += 1;
  }
  return std::sqrt(sum / count);
}

// The fit of a fold starts at the parameters that were fitted to all runs. The left-out run must not affect
// its result. A fit from the default start points therefore predicts the left-out run about as well.
TEST(BaseCandidate, FitWithoutARunAgreesWithAFitFromTheDefaultStarts) {
  std::vector<Log> logs = test::logs_of({}, 1);
  logs.push_back(test::log_of({.gain = 0.22, .delay_s = 0.1}, 9));  // differs from the other runs
  const std::vector<Record> records = make_records(logs, {});
  const Units units(records);
  std::size_t compared = 0;
  for (const BaseCandidate& candidate :
       base_candidates(records, Judged::displacement, Drive::command, records[0].largest_kpa, {})) {
    if (candidate.regulator) continue;
    const FittedParameters whole = candidate.fit(records);
    for (std::size_t unit = 0; unit < units.count(); ++unit) {
      std::vector<std::size_t> kept;
      const std::vector<Record> rest = units.without(records, unit, &kept);
      // The first candidate returns a fit that was made before.
      const BaseCandidate play = play_candidate(Drive::command);
      const FitPoint again = (candidate.description == play.description ? play : candidate).fit(rest).point;
      const double near_mm =
          rms_of_run(fit_without(candidate, whole, records, units, unit, finger_bin_s).left[unit]);
      const double far_mm = rms_of_run(left_by(candidate, again, kept, records, finger_bin_s)[unit]);
      EXPECT_NEAR(near_mm, far_mm, 0.1 * far_mm) << candidate.description << ", run " << unit;
      ++compared;
    }
  }
  EXPECT_GE(compared, 2 * records.size());
}

TEST(BaseCandidate, InitialStatesBelongToTheKeptRecords) {
  FittedParameters whole;
  whole.point.starts.resize(3);
  for (std::size_t r = 0; r < 3; ++r) whole.point.starts[r].peak_before_kpa = 10.0 * static_cast<double>(r);
  whole.numbers.peak_before_kpa = {1, 2, 3};
  const FittedParameters kept = for_records(whole, {0, 2});
  ASSERT_EQ(kept.point.starts.size(), 2U);
  EXPECT_EQ(kept.point.starts[1].peak_before_kpa, 20);
  EXPECT_EQ(kept.numbers.peak_before_kpa, (std::vector<double>{1, 3}));
  EXPECT_TRUE(kept.numbers.jumped_from_kpa.empty());  // the structure is not linear
}

TEST(BaseCandidate, PressureHasAFilterBankAndARegulator) {
  const std::vector<Record> records = pressure_records(test::logs_of({}, 1, true), false);
  const std::vector<BaseCandidate> all =
      base_candidates(records, Judged::pressure, Drive::command, records[0].largest_kpa, {});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_FALSE(all[0].regulator);
  EXPECT_TRUE(all[1].regulator);
  EXPECT_TRUE(all[0].fit(records).point.model.blocks.empty());
}

}  // namespace
}  // namespace softgrip::sysid::base_candidate_test
