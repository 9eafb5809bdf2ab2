// Tests two causes that no command can separate. A diagnosis must list both causes, even if the block of one
// cause fits the data better.

#include "sysid/diagnosis/causes/cause.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "base/random.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/fitting/trajectory.h"
#include "tests/sysid/diagnosis/campaign.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::indistinguishable_test {
namespace {

Cause cause(std::string_view id) {
  return *find_cause(id);
}

model::Model with(const model::Model& model, std::string_view id) {
  return model::with_block(model, model::neutral_block(cause(id).forms.front().type));
}

TEST(Indistinguishable, AreOnlyStiffeningAndSensorNonlinearity) {
  const model::Model model = loaded("bench_twin");
  EXPECT_TRUE(are_indistinguishable(cause("stiffening"), cause("sensor_nonlinearity"), model));
  EXPECT_TRUE(are_indistinguishable(cause("sensor_nonlinearity"), cause("stiffening"), model));
  for (const Cause& other : all_causes()) {
    if (other.id == "stiffening" || other.id == "sensor_nonlinearity") continue;
    EXPECT_FALSE(indistinguishable_from(other, model)) << other.id;
  }
}

TEST(Indistinguishable, MemoryBlockSeparatesStiffeningFromTheSensor) {
  for (const char* id : {"inertia", "backlash", "sensor_lag"})
    EXPECT_FALSE(indistinguishable_from(cause("stiffening"), with(loaded("bench_twin"), id))) << id;
  for (const char* id : {"transport_delay", "valve_lag", "ageing", "contact", "sensor_drift"})
    EXPECT_TRUE(indistinguishable_from(cause("stiffening"), with(loaded("bench_twin"), id))) << id;
}

/// A finger that stiffens more sharply than the stiffening block of the catalogue. For this reason, the block
/// of a nonlinear sensor fits the data of this finger better.
class BentRig : public ::testing::Test {
 protected:
  static Selection select() {
    const model::Model given = loaded("bench_twin");
    std::vector<Record> records = known_campaign(2);
    for (std::size_t k = 0; k < records.size(); ++k) {
      Record& r = records[k];
      r.reading_mm = predict(given, r, rest_starts(given, {r}).front());
      for (std::size_t i = 0; i < r.size(); ++i) {
        const double y = r.reading_mm[i];
        r.reading_mm[i] = y * (1 - 0.0003 * y * y) + 0.03 * normal_at(7 + k, i);
      }
    }
    SearchData data = make_search_data(records, given);
    data.threads = 1;
    StructureFit base = fit_structure(data.records, {}, data.given);
    SelectionOptions one;
    one.most_causes = 1;
    return select_causes(data, std::move(base), 0.03, divide(data.records, 8), one);
  }

  /// Returns the result of select(), which is computed during the first call and shared by all tests.
  static const Selection& selected() {
    static const Selection selection = select();
    return selection;
  }
};

TEST_F(BentRig, ListsTheIndistinguishableCauseAsAlternative) {
  const Selection& selection = selected();
  ASSERT_FALSE(selection.chosen.empty());
  const ChosenCause& chosen = selection.chosen.front();
  ASSERT_TRUE(indistinguishable_from(chosen.cause, selection.extended.point.model)) << chosen.cause.id;
  const auto indistinguishable = *indistinguishable_from(chosen.cause, selection.extended.point.model);
  const auto listed =
      std::count_if(chosen.alternatives.begin(), chosen.alternatives.end(),
                    [&](const Cause& alternative) { return alternative == indistinguishable; });
  EXPECT_EQ(listed, 1);
  // The block of the chosen cause fits the data better than the block of the other cause. Without the rule
  // for indistinguishable causes, only the chosen cause would be listed.
  const auto score = std::find_if(chosen.candidates.begin(), chosen.candidates.end(),
                                  [&](const CandidateScore& s) { return s.cause == indistinguishable; });
  ASSERT_NE(score, chosen.candidates.end());
  EXPECT_GT(score->rmse_mm, 1.02 * std::sqrt(selection.extended.mean_square_mm2));
}

TEST_F(BentRig, NoWaveformIsProposedForIndistinguishableCauses) {
  const Selection& selection = selected();
  ASSERT_FALSE(selection.chosen.empty());
  Diagnosis d;
  d.verdict = Verdict::ambiguous;
  d.records = known_campaign(2);
  d.noise_mm = 0.03;
  d.as_given = selection.base;
  d.recalibrated = selection.base;
  d.extended = selection.extended;
  NamedCause named;
  named.cause = selection.chosen.front().cause;
  named.alternatives = {*indistinguishable_from(named.cause, selection.extended.point.model)};
  d.causes = {named};
  const NextExperiment next = design_experiment(d, {});
  EXPECT_FALSE(next.best);
  ASSERT_EQ(next.advice.size(), 1U);
  EXPECT_NE(next.advice.front().find("gauge"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::indistinguishable_test
