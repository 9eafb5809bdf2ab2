#include "sysid/diagnosis/residual/outliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::outliers_test {
namespace {

constexpr double noise_mm = 0.04;

/// Returns the records with the residual `left` added to their readings.
std::vector<Record> with(std::vector<Record> records, const ByRecord& left) {
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); ++i) records[k].reading_mm[i] += left[k][i];
  }
  return records;
}

/// Returns the outliers that the search finds if the residual of the model is `left`.
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

TEST(Outliers, AreFoundDuringMotion) {
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
  EXPECT_LT(before, put);  // a comparison of readings with their neighbours misses outliers during motion
  EXPECT_EQ(before + more, put);
  EXPECT_EQ(evidence.count, put);
  EXPECT_NEAR(evidence.size_mm, 0.8, 0.02);
  EXPECT_TRUE(evidence.present);
  EXPECT_EQ(records[0].readings + records[1].readings + put, evidence.readings);
}

TEST(Outliers, NoiseContainsNoOutliers) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_EQ(found_in(noise_for(known_campaign(2), noise_mm, 0, seed)).count, 0u) << "seed " << seed;
}

// A systematic residual must not count as outliers, even if it is large. Examples are oscillations of any
// frequency, jumps that decay, and a sawtooth. By chance, up to one in a thousand readings may look isolated.
TEST(Outliers, SystematicResidualsAreNoOutliers) {
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
      {"jumps that decay", [](double t) { return 1.5 * std::exp(-std::fmod(t, 7.0)); }},
      {"sawtooth", [](double t) { return std::fmod(t, 0.11) * 10; }},
      {"fine sawtooth", [](double t) { return std::fmod(t, 0.047) * 20; }}};
  for (const auto& [name, structure] : structures) {
    const OutlierEvidence evidence = found_in(plus(noise, structure));
    EXPECT_LE(evidence.count, evidence.readings / 1000) << name;
    EXPECT_FALSE(evidence.present) << name;
  }
}

// The command jumps, and the model follows one sample too late. The large residual of this one sample must
// not count as an outlier.
TEST(Outliers, LateModelResponseIsNoOutlier) {
  std::vector<Record> records = known_campaign(1);
  ByRecord left = noise_for(records, noise_mm, 0, 9);
  for (std::size_t i = 0; i < records[0].size(); ++i)
    records[0].reading_mm[i] = (i / 200 % 2 == 0 ? 0.0 : 10.0) + left[0][i];
  for (std::size_t i = 200; i < records[0].size(); i += 200) left[0][i] += i / 200 % 2 == 0 ? -10 : 10;
  OutlierEvidence evidence;
  EXPECT_EQ(hide_outliers_beside(records, left, noise_mm, evidence), 0u);
}

/// Returns the log of a finger with a gain of 0.5 mm/kPa and a noise of 0.02 mm. The command consists of
/// triangles up to 40 kPa. Only every `every`-th sample has a reading.
Log moving(int every = 1) {
  Log log;
  log.name = "moving";
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.02);
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i;
    const double kpa = 40 * std::max(0.0, 1 - std::abs(std::fmod(t, 10) / 4 - 1));
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(kpa);
    log.displacement_mm.push_back(i % every == 0 ? 0.5 * kpa + noise(random)
                                                 : std::numeric_limits<double>::quiet_NaN());
  }
  return log;
}

/// Inserts wrong readings into a log. Tests that take_out_wrong_readings() removes exactly these readings and
/// returns one sentence that contains `number`.
void expect_taken_out(Log log, const std::map<std::size_t, double>& wrong, const std::string& number) {
  for (const auto& [sample, value] : wrong) log.displacement_mm[sample] = value;
  std::vector<Log> logs{moving(), log};
  const std::vector<Log> before = logs;
  const std::vector<std::string> sentences = take_out_wrong_readings(logs);
  ASSERT_EQ(sentences.size(), 1U);
  EXPECT_NE(sentences[0].find(number), std::string::npos) << sentences[0];
  for (std::size_t k = 0; k < logs.size(); ++k) {
    for (std::size_t i = 0; i < logs[k].size(); ++i) {
      const bool taken =
          std::isfinite(before[k].displacement_mm[i]) && !std::isfinite(logs[k].displacement_mm[i]);
      EXPECT_EQ(taken, k == 1 && wrong.count(i) > 0) << logs[k].time_s[i] << " s";
    }
  }
}

TEST(WrongReadings, ErrorCodesAreRemovedAtAnyPosition) {
  expect_taken_out(moving(), {{0, 9999}, {1, 9999}, {700, 9999}, {1999, 9999}},
                   "4 of 2000 readings are outliers");
  expect_taken_out(moving(), {{500, -999}, {501, -999}, {502, -999}, {503, -999}}, "-999 mm at 10 s");
}

TEST(WrongReadings, IsolatedReadingsAreRemovedForSlowSensorsToo) {
  expect_taken_out(moving(), {{300, 31.5}, {907, -22.5}, {1500, 44.5}}, "3 of 2000 readings are outliers");
  expect_taken_out(moving(20), {{300, 81.5}, {900, -22.5}, {1500, 44.5}}, "3 of 100 readings are outliers");
}

TEST(WrongReadings, FirstOrLastReadingCanBeRemoved) {
  expect_taken_out(moving(), {{0, 431.7}}, "1 of 2000 readings is an outlier");
  expect_taken_out(moving(), {{1999, -388.1}}, "-388.1 mm");
}

TEST(WrongReadings, FirstReadingWithinTheMotionIsRemovedIfNothingMoves) {
  Log log = moving();
  for (std::size_t i = 0; i < 50; ++i) {
    log.pressure_command_kpa[i] = 20;
    log.displacement_mm[i] = 10 + 0.02 * std::sin(1.0 * static_cast<double>(i * i));
  }
  expect_taken_out(log, {{0, 2.5}}, "2.5 mm at 0 s");
  expect_taken_out(log, {{0, 0.0}}, "0 mm at 0 s");
  log.pressure_command_kpa[0] = 5;  // the pressure jumps after the first sample, so the reading may jump too
  log.displacement_mm[0] = 2.5;
  std::vector<Log> logs{log};
  EXPECT_TRUE(take_out_wrong_readings(logs).empty());
}

TEST(WrongReadings, NoReadingIsRemovedFromACorrectMotion) {
  Log step = moving();
  for (std::size_t i = 0; i < step.size(); ++i) {
    step.pressure_command_kpa[i] = i == 0 ? 0 : 40;
    step.displacement_mm[i] = (i < 2 ? 0 : 20) + 0.02 * std::sin(1.0 * static_cast<double>(i * i));
  }
  Log without_noise = moving();
  for (std::size_t i = 0; i < without_noise.size(); ++i)
    without_noise.displacement_mm[i] = 0.5 * without_noise.pressure_command_kpa[i];
  std::vector<Log> logs{moving(), moving(20), step, without_noise};
  const std::vector<Log> before = logs;
  EXPECT_TRUE(take_out_wrong_readings(logs).empty());
  for (std::size_t k = 0; k < logs.size(); ++k) {
    for (std::size_t i = 0; i < logs[k].size(); ++i)
      EXPECT_EQ(std::isfinite(logs[k].displacement_mm[i]), std::isfinite(before[k].displacement_mm[i]));
  }
}

}  // namespace
}  // namespace softgrip::sysid::outliers_test
