#include "sysid/diagnosis/evidence/evidence.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "model/catalogue.h"
#include "model/model.h"
#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::evidence_test {
namespace {

constexpr double noise_mm = 0.03;

ResidualEvidence examined(const std::vector<Record>& records, const ByRecord& residual,
                          double noise = noise_mm, std::uint64_t seed = 1) {
  const Samples samples = pooled_samples(records, residual, 6000);
  return examine_residual(records, residual, samples, conditions_of(records, readings_of(records), samples),
                          noise, seed);
}

const ConditionEvidence& of(const ResidualEvidence& evidence, const std::string& id) {
  for (const ConditionEvidence& e : evidence.conditions) {
    if (e.condition.id == id) return e;
  }
  throw std::out_of_range(id);
}

struct FalseAlarms {
  std::map<std::string, int> below_5_percent;  ///< for each condition, number of cases in which the
                                               ///< unadjusted p-value is below 5 %
  double mean_p = 0;
  int any_clear = 0;
  int line = 0;
};

constexpr int worlds = 80;

FalseAlarms count_alarms(double correlation) {
  const std::vector<Record> records = known_campaign(3);
  FalseAlarms alarms;
  int judged = 0;
  for (int seed = 1; seed <= worlds; ++seed) {
    const auto number = static_cast<std::uint64_t>(seed);
    const ResidualEvidence evidence =
        examined(records, noise_for(records, 0.1, correlation, number), noise_mm, number);
    bool any = false;
    for (const ConditionEvidence& e : evidence.conditions) {
      if (!e.condition.why_not.empty()) continue;
      alarms.below_5_percent[e.condition.id] += e.p_value < 0.05 ? 1 : 0;
      alarms.mean_p += e.p_value;
      ++judged;
      any |= e.clear;
    }
    alarms.any_clear += any ? 1 : 0;
    alarms.line += evidence.spectrum.p_value < 0.01 ? 1 : 0;
  }
  alarms.mean_p /= judged;
  return alarms;
}

/// Returns an upper limit for the number of false alarms if a false alarm has the probability `rate` in each
/// case. The limit is the mean plus three standard deviations of the binomial distribution.
int at_most(double rate) {
  return static_cast<int>(worlds * rate + 3 * std::sqrt(worlds * rate * (1 - rate)));
}

TEST(Evidence, WhiteErrorsGiveUniformPValues) {
  const FalseAlarms alarms = count_alarms(0);
  for (const auto& [id, count] : alarms.below_5_percent) EXPECT_LE(count, at_most(0.05)) << id;
  EXPECT_GT(alarms.mean_p, 0.4);
  EXPECT_LT(alarms.mean_p, 0.6);
  EXPECT_LE(alarms.any_clear, at_most(0.05));
  EXPECT_LE(alarms.line, at_most(0.01));
}

TEST(Evidence, CorrelatedErrorsRaiseNoMoreFalseAlarms) {
  // A correlation of 0.974 between samples at 50 Hz and a correlation of 0.987 between samples at 100 Hz have
  // the same correlation time.
  const FalseAlarms alarms = count_alarms(0.974);
  for (const auto& [id, count] : alarms.below_5_percent) EXPECT_LE(count, at_most(0.05)) << id;
  EXPECT_GT(alarms.mean_p, 0.4);
  EXPECT_LE(alarms.any_clear, at_most(0.05));
  EXPECT_LE(alarms.line, at_most(0.01));
}

TEST(Evidence, ErrorProportionalToRateIsAttributedToRate) {
  const std::vector<Record> records = known_campaign(3);
  ByRecord residual = noise_for(records, noise_mm, 0, 7);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const DriveHistory h = history_of(records[k]);
    for (std::size_t i = 0; i < residual[k].size(); ++i) residual[k][i] += 0.01 * h.rate_kpa_per_s[i];
  }
  const ResidualEvidence evidence = examined(records, residual);
  // The error is proportional to the rate of the pressure. The condition "rate" must therefore explain almost
  // the whole error. While the pressure is constant, both the rate and the error are 0.
  EXPECT_EQ(evidence.conditions.front().condition.id, "rate");
  EXPECT_TRUE(evidence.conditions.front().clear);
  EXPECT_GT(evidence.conditions.front().share_percent, 90);
  EXPECT_NE(dependence_sentence(evidence).find("the rate of the pressure"), std::string::npos);
  for (const ConditionBin& bin : evidence.conditions.front().bins)
    EXPECT_NEAR(bin.mean_mm, 0.01 * bin.value, 0.02) << bin.value;
  EXPECT_FALSE(of(evidence, "campaign_time").clear);
}

TEST(Evidence, ErrorGrowthAtConstantPressureIsAttributedToDwell) {
  const std::vector<Record> records = known_campaign(3);
  ByRecord residual = noise_for(records, noise_mm, 0, 8);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const DriveHistory h = history_of(records[k]);
    for (std::size_t i = 0; i < residual[k].size(); ++i) {
      if (h.dwell_s[i] > 0) residual[k][i] += 0.1 * std::log(h.dwell_s[i]);
    }
  }
  const ResidualEvidence evidence = examined(records, residual);
  EXPECT_EQ(evidence.conditions.front().condition.id, "dwell");
  EXPECT_GT(evidence.conditions.front().share_percent, 70);
}

TEST(Evidence, AColumnThatIsMissingIsNotJudged) {
  const std::vector<Record> records = known_campaign(2);
  const ResidualEvidence evidence = examined(records, noise_for(records, noise_mm, 0, 9));
  EXPECT_FALSE(of(evidence, "temperature").condition.why_not.empty());
  EXPECT_EQ(of(evidence, "temperature").share_percent, 0);
  EXPECT_FALSE(evidence.conditions.back().condition.why_not.empty());
}

TEST(Evidence, ALineInTheSpectrumIsFoundWithItsAmplitude) {
  const std::vector<Record> records = known_campaign(3);
  ByRecord residual = noise_for(records, noise_mm, 0, 10);
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < residual[k].size(); ++i)
      residual[k][i] += 0.02 * std::sin(2 * std::numbers::pi * 7.3 * records[k].time_s[i]);
  }
  const SpectrumEvidence spectrum = examined(records, residual).spectrum;
  EXPECT_NEAR(spectrum.peak_hz, 7.3, 0.03);
  EXPECT_NEAR(spectrum.peak_amplitude_mm, 0.02, 0.003);
  EXPECT_LT(spectrum.p_value, 1e-6);
  EXPECT_GT(spectrum.share_percent, 70);
}

TEST(Unphysical, InverseResponseZeroStiffnessAndSlowCreepAreFlagged) {
  const std::vector<Record> records = known_campaign(1);
  model::Model model = model::with_block({"m", "", {}}, model::default_block(*model::find_block("bouc_wen")));
  model = model::with_block(model, model::default_block(*model::find_block("kelvin_voigt"), 2));
  const auto signs_of = [&](const std::string& path, double value) {
    std::vector<double> values = model::flat_values(model);
    values[*model::find_path(model, path)] = value;
    std::string ids;
    for (const UnphysicalSign& sign : unphysical_signs(model::with_values(model, values), records))
      ids += sign.name + " " + sign.formerly + " ";
    return ids;
  };
  EXPECT_EQ(signs_of("bouc_wen.beta_mm_per_kpa", 0.2), "");
  EXPECT_NE(signs_of("bouc_wen.beta_mm_per_kpa", 0.9).find("inverse_response wrong_way_first"),
            std::string::npos);
  EXPECT_NE(signs_of("kelvin_voigt.k1_kpa_per_mm", 0.3).find("stiffness_near_zero"), std::string::npos);
  EXPECT_NE(signs_of("kelvin_voigt.c1_kpa_s_per_mm", 900).find("creep_beyond_data"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::evidence_test
