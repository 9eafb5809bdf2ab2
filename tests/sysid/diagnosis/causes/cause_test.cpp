#include "sysid/diagnosis/causes/cause.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/catalogue.h"
#include "sysid/diagnosis/search/fit.h"
#include "tests/model/presets.h"
#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid {
namespace {

Scales typical_scales() {
  Scales s = scales_of(known_campaign(3));
  s.largest_supply_kpa = 500;
  s.has_supply = s.has_temperature = true;
  s.residual_lines = {{1.5, 0.1, 0.1}, {4.0, 0.02, -0.1}};
  return s;
}

model::Model twin() {
  return model::without_block(
      model::without_block(model::testing::preset("bench_twin"), *model::find_block("transport_delay")),
      *model::find_block("valve_lag"));
}

TEST(Causes, EveryStartIsAValidModelThatAFitCanMove) {
  for (const Cause& cause : all_causes()) {
    if (cause.id == "outliers") continue;
    const std::vector<CauseStart> starts = cause_starts(cause, typical_scales());
    EXPECT_FALSE(starts.empty()) << cause.id;
    for (const CauseStart& start : starts) {
      const model::Model model = model::with_block(twin(), start.block);
      ASSERT_TRUE(model::validate(model).empty()) << model::validate(model).front();
      bool moves = false;
      for (std::size_t i = 0; i < start.block.values.size(); ++i) {
        if (!is_fitted(cause, start.block, i)) continue;
        moves = true;
        const Range range = fit_range(cause, i, model, typical_scales());
        EXPECT_LT(range.lower, range.upper) << cause.id << " value " << i;
      }
      EXPECT_TRUE(moves) << cause.id;
    }
  }
}

// A fit moves what belongs to the form that its start has, and nothing of the block's other forms.
TEST(Causes, FormsAreFittedApart) {
  const std::vector<Record> records = known_campaign(1);
  for (const std::string_view id : {"asymmetric_hysteresis", "rate_dependent_hysteresis", "sensor_drift",
                                    "stress_softening", "ageing", "valve_deadband"}) {
    const Cause cause = *find_cause(id);
    const std::size_t bare = structure_space(records, twin(), {}).size();
    std::vector<std::size_t> counts;
    for (const CauseStart& start : cause_starts(cause, typical_scales())) {
      const FitSpace space = structure_space(records, model::with_block(twin(), start.block), {cause});
      const std::size_t singles = model::catalogue()[cause.type].parameters.size();
      if (has_free_form(cause, start.block)) {
        EXPECT_EQ(space.size() - bare, start.block.values.size() - singles) << id << ": the knots";
        continue;
      }
      counts.push_back(space.size() - bare);
    }
    EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 3u) << id;
    EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 1u) << id;
  }
}

// Where a block would be something else by another name, a fit may not go.
TEST(Causes, StayWhatTheyAreCalled) {
  const std::vector<Record> records = known_campaign(2);
  const auto largest = [&](std::string_view id, std::string_view parameter) {
    const Cause cause = *find_cause(id);
    const model::Model model = model::with_block(twin(), cause_starts(cause, typical_scales()).front().block);
    const FitSpace space = structure_space(records, model, {cause});
    for (const FreeParameter& p : space.free()) {
      if (p.name == std::string(id) + "." + std::string(parameter)) return std::pair(p.lower, p.upper);
    }
    return std::pair(std::nan(""), std::nan(""));
  };
  EXPECT_LE(largest("rate_dependent_hysteresis", "width_kpa").second, records[1].largest_kpa);
  EXPECT_LE(largest("inertia", "damping_ratio").second, std::sqrt(0.5));
  EXPECT_GE(largest("contact", "position_mm").first, 0.01 * records[0].span_mm);
  EXPECT_GE(largest("slow_creep", "time_constant_s").first, 16.0);  // the twin's slowest branch: 16.5 s
  EXPECT_GE(largest("periodic_disturbance", "frequency_hz").first, 0.2 - 1e-12);
}

// Bands of a valve that jumps: wherever the true band is, a start is near enough to keep step with it.
TEST(Causes, NoStaircaseIsMissed) {
  std::vector<double> bands;
  const Scales scales = typical_scales();
  for (const CauseStart& start : cause_starts(*find_cause("valve_deadband"), scales)) {
    if (start.block.values[1] == 1) bands.push_back(start.block.values[0]);
  }
  for (double band = 0.018 * scales.largest_kpa; band < 0.19 * scales.largest_kpa; band *= 1.003) {
    double nearest = 1;
    for (const double start : bands)
      nearest = std::min(nearest, std::fabs(scales.largest_kpa / start - scales.largest_kpa / band));
    EXPECT_LE(nearest, 0.51) << band;
  }
}

}  // namespace
}  // namespace softgrip::sysid
