#include "sysid/diagnosis/residual/outliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::outliers_test {
namespace {

constexpr double noise_mm = 0.04;

/// Returns records whose readings are the original readings plus the residual `left`.
std::vector<Record> with(std::vector<Record> records, const ByRecord& left) {
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); ++i) records[k].reading_mm[i] += left[k][i];
  }
  return records;
}

/// Returns the outliers that the search finds when the residual of the model is `left`.
OutlierEvidence found_in(const ByRecord& left) {
  std::vector<Record> records = with(known_campaign(2), left);
  OutlierEvidence evidence;
  evidence.readings = records[0].readings + records[1].readings;
  (void)hide_outliers_beside(records, left, noise_mm, evidence);
  return evidence;
}

ByRecord plus(ByRecord left, double (*structure)(double time_s)) {
  for (std::vector<double>& one : left) {
    for (std::size_t i = 0; i < one.size(); ++i) one[i] += structure(0.02 * static_cast<double>(i));
  }
  return left;
}

TEST(Outliers, AreFoundInTheMidstOfAMotion) {
  const std::vector<Record> campaign = known_campaign(2);
  ByRecord left = noise_for(campaign, noise_mm, 0, 5);
  std::size_t put = 0;
  for (std::vector<double>& one : left) {
    for (std::size_t i = 20; i + 20 < one.size(); i += 70, ++put) one[i] += put % 2 == 0 ? 0.8 : -0.8;
  }
  std::vector<Record> records = with(campaign, left);
  OutlierEvidence evidence = hide_outliers(records, noise_mm);
  const std::size_t before = evidence.count;
  for (std::size_t k = 0; k < left.size(); ++k) {
    for (std::size_t i = 0; i < left[k].size(); ++i) {
      if (std::isnan(records[k].reading_mm[i])) left[k][i] = std::nan("");
    }
  }
  const std::size_t more = hide_outliers_beside(records, left, noise_mm, evidence);
  EXPECT_LT(before, put);  // during motion, a comparison with neighbouring readings would miss outliers
  EXPECT_EQ(before + more, put);
  EXPECT_EQ(evidence.count, put);
  EXPECT_NEAR(evidence.size_mm, 0.8, 0.02);
  EXPECT_TRUE(evidence.present);
  EXPECT_EQ(records[0].readings + records[1].readings + put, evidence.readings);
}

TEST(Outliers, NoiseHasNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_EQ(found_in(noise_for(known_campaign(2), noise_mm, 0, seed)).count, 0u) << "seed " << seed;
}

// A systematic residual must not be reported as an outlier, even if it is large. Examples are an oscillation
// of any frequency, impacts, and a sawtooth. By chance, one of a thousand corners of the sawtooth may look
// isolated.
TEST(Outliers, StructureIsNone) {
  const ByRecord noise = noise_for(known_campaign(2), noise_mm, 0, 7);
  const std::vector<std::pair<const char*, double (*)(double)>> structures{
      {"slow ringing", [](double t) { return 2 * std::sin(2 * std::numbers::pi * 1.3 * t); }},
      {"ringing", [](double t) { return 2 * std::sin(2 * std::numbers::pi * 6.1 * t); }},
      {"fast ringing", [](double t) { return 2 * std::sin(2 * std::numbers::pi * 17.3 * t); }},
      {"ringing with a decaying amplitude",
       [](double t) {
         const double since = std::fmod(t, 5.0);
         return 3 * std::exp(-6 * since) * std::sin(2 * std::numbers::pi * 5 * since);
       }},
      {"knocks", [](double t) { return 1.5 * std::exp(-std::fmod(t, 7.0)); }},
      {"staircase", [](double t) { return std::fmod(t, 0.11) * 10; }},
      {"fine staircase", [](double t) { return std::fmod(t, 0.047) * 20; }}};
  for (const auto& [name, structure] : structures) {
    const OutlierEvidence evidence = found_in(plus(noise, structure));
    EXPECT_LE(evidence.count, evidence.readings / 1000) << name;
    EXPECT_FALSE(evidence.present) << name;
  }
}

// The command jumps, and the model follows one sample late. The single large residual at each jump must not
// be reported as an outlier.
TEST(Outliers, LatenessIsNone) {
  std::vector<Record> records = known_campaign(1);
  ByRecord left = noise_for(records, noise_mm, 0, 9);
  for (std::size_t i = 0; i < records[0].size(); ++i)
    records[0].reading_mm[i] = (i / 200 % 2 == 0 ? 0.0 : 10.0) + left[0][i];
  for (std::size_t i = 200; i < records[0].size(); i += 200) left[0][i] += i / 200 % 2 == 0 ? -10 : 10;
  OutlierEvidence evidence;
  EXPECT_EQ(hide_outliers_beside(records, left, noise_mm, evidence), 0u);
}

}  // namespace
}  // namespace softgrip::sysid::outliers_test
