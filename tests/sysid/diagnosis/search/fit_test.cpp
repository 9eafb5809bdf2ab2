#include "sysid/diagnosis/search/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/blocks/backlash.h"
#include "model/blocks/stress_softening.h"
#include "model/named.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::fit_test {
namespace {

using model::SignalName;

TEST(WithoutEffects, ReturnsTheReadingsOfTheFingerWithoutTheCauses) {
  const model::Model bare = loaded("bench_twin");
  model::Model with =
      model::with_block(bare, model::block_of<model::StressSoftening>({{"softening_per_kpa", 0.002}}));
  with = model::with_block(with, model::block_of<model::Backlash>({{"gap_mm", 0.5}}));
  const auto records_of = [](const model::Model& finger) {
    return make_records({simulated(finger, SignalName::tp1, 50, 0, 1)}, {});
  };
  const std::vector<Record> wanted = records_of(bare), given = records_of(with);
  const std::vector<Cause> both{*find_cause("stress_softening"), *find_cause("backlash")};
  const FitPoint truth{with, rest_starts(with, given)};
  const std::vector<Record> left = without_effects(given, truth, both);
  const std::vector<Record> half = without_effects(given, truth, {both.front()});
  double apart_mm = 0;
  ASSERT_EQ(left[0].size(), wanted[0].size());
  for (std::size_t i = 0; i < left[0].size(); ++i) {
    EXPECT_NEAR(left[0].reading_mm[i], wanted[0].reading_mm[i], 1e-5) << i;
    apart_mm = std::max(apart_mm, std::abs(half[0].reading_mm[i] - wanted[0].reading_mm[i]));
  }
  EXPECT_GT(apart_mm, 0.1)
      << "the effect of the backlash must remain, because only the softening was removed";
}

TEST(EvaluateStructure, MeanSquareIsInfiniteIfAPredictionIsNaN) {
  const model::Model bare = loaded("bench_twin");
  auto records = make_records({simulated(bare, SignalName::tp1, 50, 0.05, 1)}, {});
  records[0].reading_mm[3] = std::nan("");
  FitPoint point{bare, rest_starts(bare, records)};
  EXPECT_NEAR(std::sqrt(evaluate_structure(records, {}, point).mean_square_mm2), 0.05, 0.005);
  point.starts[0].offset_mm = std::nan("");
  EXPECT_EQ(evaluate_structure(records, {}, point).mean_square_mm2, HUGE_VAL);
}

}  // namespace
}  // namespace softgrip::sysid::fit_test
