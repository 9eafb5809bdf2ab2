#include "sysid/diagnosis/search/holdout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sysid/diagnosis/search/search.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::holdout_test {
namespace {

TEST(HeldOutLosses, AreAtMostTheSpansSquare) {
  std::vector<Record> records =
      make_records({simulated(loaded("bench_twin"), model::SignalName::tp1, 25, 0.05, 3)}, {});
  const SearchData data = make_search_data(records, loaded("zhang2025"));
  const StructureFit fit = evaluate_structure(records, {}, data.given);
  const Division division = divide(records, 8);
  const BlockLosses losses = held_out_losses(records, division, fit);
  const double most = *std::max_element(losses.begin(), losses.end());
  EXPECT_LT(most, records[0].span_mm * records[0].span_mm);
  records[0].span_mm = 0.5 * std::sqrt(most);
  const BlockLosses cut = held_out_losses(records, division, fit);
  for (std::size_t b = 0; b < losses.size(); ++b)
    EXPECT_DOUBLE_EQ(cut[b], std::min(losses[b], 0.25 * most)) << b;
}

/// A log is held out. A changed zero offset or a start in motion must not increase the error of this log.
TEST(LeftOutLosses, AreThoseOfAStartThatTheFirstReadingsTell) {
  const model::Model twin = loaded("bench_twin");
  std::vector<Log> logs{simulated(twin, model::SignalName::tp1, 25, 0.05, 3),
                        simulated(twin, model::SignalName::sp2, 25, 0.05, 4)};
  logs.push_back(slice(logs[0], logs[0].size() / 3, logs[0].size()));
  for (double& y : logs[1].displacement_mm) y += 5;
  const std::vector<Record> records = make_records(logs, {});
  const StructureFit fit = fit_structure(records, {}, {twin, rest_starts(twin, records)});
  const Division by_unit = divide_by_unit(records);
  const BlockLosses losses = left_out_losses(records, by_unit, fit);
  ASSERT_EQ(losses.size(), by_unit.blocks.size());
  for (std::size_t b = 0; b < losses.size(); ++b) {
    const bool in_motion = by_unit.blocks[b].record == 2;
    EXPECT_LT(std::sqrt(losses[b]), in_motion ? 0.02 * 30 : 1.3 * 0.05) << b;
  }
}

}  // namespace
}  // namespace softgrip::sysid::holdout_test
