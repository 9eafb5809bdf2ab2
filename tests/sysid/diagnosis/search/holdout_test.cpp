#include "sysid/diagnosis/search/holdout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/search.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::holdout_test {
namespace {

TEST(HeldOutLosses, AreLimitedToTheSquareOfTheSpan) {
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

/// If a complete log is left out, a different zero offset must not increase the error of this log. After a
/// start in motion, the error must be below 2 % of the span.
TEST(LeftOutLosses, IgnoreOffsetAndStartInMotionOfALeftOutLog) {
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

constexpr double noise_mm = 0.05;

StructureFit fitted(const std::vector<Record>& records) {
  const model::Model model = loaded("bench_twin");
  return fit_structure(records, {}, {model, rest_starts(model, records)});
}

TEST(LinearHeldOutLosses, MatchTheLossesOfExactRefits) {
  const std::vector<Record> records =
      make_records({simulated(loaded("bench_twin"), model::SignalName::tp1, 25, noise_mm, 11)}, {});
  const StructureFit fit = fitted(records);
  const Division division = divide(records, 3);
  const double refitted_mm = rmse_mm(held_out_losses(records, division, fit));
  EXPECT_NEAR(rmse_mm(linear_held_out_losses(records, division, fit)), refitted_mm, 0.05 * refitted_mm);
}

/// The log contains one jump and long holds. If the block with the jump is held out, the remaining readings
/// contain almost no information about the delay of the response.
TEST(LinearHeldOutLosses, StayBelowThreeTimesTheNoiseForASingleJump) {
  const model::Model model = loaded("bench_twin");
  Log log;
  log.name = "jump";
  for (int i = 0; i < 4000; ++i) {
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(log.time_s.back() < 12 ? 0 : 40);
    log.displacement_mm.push_back(0);
  }
  const std::vector<Record> blank = make_records({log}, {});
  const StructureFit at_truth = evaluate_structure(blank, {}, {model, rest_starts(model, blank)});
  const Log noise = simulated(model, model::SignalName::tp1, 100, noise_mm, 3);
  const Log quiet = simulated(model, model::SignalName::tp1, 100, 0, 3);
  for (std::size_t i = 0; i < log.time_s.size(); ++i) {
    log.displacement_mm[i] =
        -at_truth.residual_mm[0][i] + noise.displacement_mm[i] - quiet.displacement_mm[i];
  }
  const std::vector<Record> records = make_records({log}, {});
  const BlockLosses losses = linear_held_out_losses(records, divide(records, 8), fitted(records));
  for (const double loss_mm2 : losses) EXPECT_LT(std::sqrt(loss_mm2), 3 * noise_mm);
}

}  // namespace
}  // namespace softgrip::sysid::holdout_test
