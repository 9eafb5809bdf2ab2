// Tests the number of causes that a search selects. If the equation of the first cause is inexact, a small
// error remains. This error must not lead to a second cause. A small effect of a different type must lead to
// a second cause.

#include "sysid/diagnosis/search/selection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/evidence/veto.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/diagnosis/campaign.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::selection_test {
namespace {

constexpr double noise_mm = 0.03;

/// Replaces each reading y of bench_twin by `bend(y, t)`, where t is the time since the start of the
/// campaign. Returns the causes that the search selects for these readings.
Selection select(const std::function<double(double y_mm, double t_s)>& bend,
                 const SelectionOptions& options = {}) {
  const model::Model given = loaded("bench_twin");
  std::vector<Record> records = known_campaign(2);
  for (std::size_t k = 0; k < records.size(); ++k) {
    Record& r = records[k];
    r.reading_mm = predict(given, r, rest_starts(given, {r}).front());
    for (std::size_t i = 0; i < r.size(); ++i) {
      r.reading_mm[i] =
          bend(r.reading_mm[i], r.campaign_time_s + r.time_s[i]) + noise_mm * normal_at(7 + k, i);
    }
  }
  SearchData data = make_search_data(records, given);
  StructureFit base = fit_structure(data.records, {}, data.given);
  data.scales.residual_lines = spectrum_peaks(data.records, base.residual_mm);
  return select_causes(data, std::move(base), noise_mm, divide(data.records, 8), options);
}

std::vector<std::string> names(const Selection& selection) {
  std::vector<std::string> ids;
  for (const ChosenCause& chosen : selection.chosen) ids.emplace_back(chosen.cause.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Returns the reading of a nonlinear sensor. The nonlinearity is not a polynomial, so the sensor block of
/// the catalogue leaves a few percent of it unexplained.
double bent(double y_mm) {
  return y_mm + 1.2 * std::sin(1.3 * std::numbers::pi * y_mm / 20);
}

TEST(Selection, InexactFormOfACauseAddsNoSecondCause) {
  const Selection selection = select([](double y_mm, double) { return bent(y_mm); });
  EXPECT_TRUE(selection.left.present)
      << "the block form of the cause fits exactly, so this test is not meaningful";
  ASSERT_EQ(selection.chosen.size(), 1U);
  EXPECT_EQ(names(selection), std::vector<std::string>{"sensor_nonlinearity"});
}

TEST(Selection, SmallEffectOfADifferentTypeIsNamed) {
  const Selection selection = select([](double y_mm, double t_s) {
    return y_mm * (1 + 0.15 * t_s / 120) + 0.09 * std::sin(2 * std::numbers::pi * 3.1 * t_s);
  });
  EXPECT_EQ(names(selection), (std::vector<std::string>{"ageing", "periodic_disturbance"}));
  // The disturbance explains less than 5 % of the error. The inexact equation of a cause with a large effect
  // could leave a larger error than this.
  const double excess = selection.base_unexplained.excess_mm;
  EXPECT_LT(0.09 * 0.09 / 2, 0.05 * excess * excess);
}

/// The disturbance has a different amplitude in each run. A fit to all runs leads to an amplitude that does
/// not occur in any run, so it does not predict a left-out run.
TEST(Selection, DisturbanceWithVaryingAmplitudeIsNotNamed) {
  SelectionOptions one;
  one.most_causes = 1;
  const Selection selection = select(
      [](double y_mm, double t_s) {
        return y_mm + (t_s < 60 ? 0.3 : 0.06) * std::sin(2 * std::numbers::pi * 3.1 * t_s);
      },
      one);
  EXPECT_EQ(names(selection), std::vector<std::string>{});
  ASSERT_FALSE(selection.last_candidates.empty());
  EXPECT_EQ(selection.last_candidates.front().cause.id, "periodic_disturbance");
  EXPECT_EQ(selection.last_candidates.front().why_not, reason_of(Veto::not_predictive));
}

}  // namespace
}  // namespace softgrip::sysid::selection_test
