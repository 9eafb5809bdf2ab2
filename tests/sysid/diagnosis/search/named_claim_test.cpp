// Tests the conditions under which a cause may be named. For each condition, one test violates this condition
// and meets all other conditions.

#include "sysid/diagnosis/search/named_claim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "sysid/diagnosis/search/search.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/diagnosis/campaign.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::named_claim_test {
namespace {

/// A test case with two runs of bench_twin, a cause that is fitted to the runs, and prescribed errors on
/// held-out runs.
struct Case {
  std::vector<Record> records = known_campaign(2);
  Cause cause;
  StructureFit without, with;
  double error_without = 1, error_with = 0.5;  ///< error in every block of the held-out runs, without the
                                               ///< cause and with the cause
  int asked = 0;

  /// @param bend  function that distorts a reading [mm] at a given time since the start of the campaign [s].
  template <class Bend>
  Case(const char* id, Bend bend) : cause(*find_cause(id)) {
    const model::Model twin = loaded("bench_twin");
    for (std::size_t k = 0; k < records.size(); ++k) {
      Record& r = records[k];
      r.reading_mm = predict(twin, r, rest_starts(twin, {r}).front());
      for (std::size_t i = 0; i < r.size(); ++i)
        r.reading_mm[i] = bend(r.reading_mm[i], r.campaign_time_s + r.time_s[i]) + 0.03 * normal_at(5 + k, i);
    }
    SearchData data = make_search_data(records, twin);
    without = fit_structure(records, {}, data.given);
    std::vector<Candidate> found = fit_candidates(data, without, {.only = {cause}});
    if (found.size() == 1 && found[0].fit) with = *found[0].fit;
  }

  Veto veto() {
    const LeftOutLosses left_out = [this](const StructureFit& fit) {
      ++asked;
      const double error = fit.causes.empty() ? error_without : error_with;
      return BlockLosses(divide_by_unit(records).blocks.size(), error * error);
    };
    return veto_of(records, cause, with, without, left_out, 1);
  }
};

double aged(double y_mm, double t_s) {
  return y_mm * (1 + 0.1 * t_s / 120);
}

TEST(NamedClaim, TrueCauseMeetsAllConditions) {
  Case ageing("ageing", aged);
  ASSERT_FALSE(ageing.with.causes.empty());
  EXPECT_EQ(ageing.veto(), Veto::none);
  EXPECT_EQ(ageing.asked, 2);
}

TEST(NamedClaim, FailsWhereLeftOutRunsAreNotPredictedBetter) {
  Case ageing("ageing", aged);
  ageing.error_with = ageing.error_without;
  EXPECT_EQ(ageing.veto(), Veto::not_predictive);
}

TEST(NamedClaim, FailsIfTheSizeIntervalContainsZero) {
  Case ageing("ageing", [](double y_mm, double) { return y_mm; });
  ASSERT_FALSE(ageing.with.causes.empty());
  EXPECT_EQ(ageing.veto(), Veto::size_uncertain);
}

TEST(NamedClaim, FailsIfTheRequiredConditionIsNeverMet) {
  Case drift("sensor_drift", [](double y_mm, double t_s) { return y_mm + 2 * t_s / 120; });
  ASSERT_FALSE(drift.with.causes.empty());
  EXPECT_EQ(drift.veto(), Veto::none);
  // The pressure is changed so that it never rests at 0 kPa. A drift of the zero offset then cannot be
  // separated from a motion of the finger.
  for (Record& record : drift.records) {
    for (double& p : record.drive_kpa)
      p += p < 1 ? 20 * normal_at(9, static_cast<std::uint64_t>(&p - record.drive_kpa.data())) : 0;
  }
  EXPECT_EQ(drift.veto(), Veto::not_tested);
}

// The offset of the sensor moves at random. In these walks, each parameter of a piecewise linear drift is
// uncertain, although the drift is certain.
TEST(NamedClaim, RandomDriftMeetsAllConditions) {
  for (const std::uint64_t seed : {1U, 2U, 4U, 5U}) {
    SCOPED_TRACE(seed);
    std::vector<double> walk_mm{0};
    for (std::uint64_t i = 0; i < 6000; ++i) walk_mm.push_back(walk_mm.back() + 0.02 * normal_at(seed, i));
    Case drift("sensor_drift", [&](double y_mm, double t_s) {
      return y_mm + walk_mm[static_cast<std::size_t>(std::lround(t_s / 0.02))];
    });
    ASSERT_TRUE(has_free_form(drift.with.point.model, drift.cause));
    EXPECT_EQ(drift.veto(), Veto::none);
    EXPECT_EQ(drift.asked, 0) << "a free form cannot predict other runs";
  }
}

TEST(NamedClaim, FailsIfTheEffectIsAbsentWhereRequired) {
  Case ageing("ageing", aged);
  // The residuals are changed so that the cause reduces the residual only at small displacements.
  for (std::size_t r = 0; r < ageing.records.size(); ++r) {
    for (std::size_t i = 0; i < ageing.records[r].size(); ++i) {
      if (ageing.records[r].reading_mm[i] > 8)
        ageing.with.residual_mm[r][i] = ageing.without.residual_mm[r][i];
    }
  }
  EXPECT_EQ(ageing.veto(), Veto::absent_where_required);
}

}  // namespace
}  // namespace softgrip::sysid::named_claim_test
