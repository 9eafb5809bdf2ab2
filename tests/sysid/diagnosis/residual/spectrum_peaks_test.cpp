#include "sysid/diagnosis/residual/spectrum_peaks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "base/random.h"

namespace softgrip::sysid::spectrum_peaks_test {
namespace {

struct Campaign {
  std::vector<Record> records;
  std::vector<std::vector<double>> residual_mm;
};

/// Returns two records of 60 s with an oscillation and noise. The phase of the oscillation is continuous from
/// the first record to the second one. The drive oscillates with another frequency.
Campaign campaign(double frequency_hz, double amplitude_mm, double jitter_s, double drive_hz = 0.45) {
  Campaign c;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> off(-jitter_s, jitter_s);
  for (int k = 0; k < 2; ++k) {
    Record record;
    record.campaign_time_s = 60.0 * k;
    std::vector<double> residual;
    for (int i = 0; i < 6000; ++i) {
      record.time_s.push_back(0.01 * i + (jitter_s > 0 && i > 0 ? off(random) : 0));
      const double t = record.campaign_time_s + record.time_s.back();
      record.drive_kpa.push_back(30 - 30 * std::cos(2 * std::numbers::pi * drive_hz * t));
      residual.push_back(amplitude_mm * std::sin(2 * std::numbers::pi * frequency_hz * t + 0.7) +
                         0.04 * normal_at(9, std::uint64_t{6000} * static_cast<std::uint64_t>(k) +
                                                 static_cast<std::uint64_t>(i)));
    }
    c.records.push_back(std::move(record));
    c.residual_mm.push_back(std::move(residual));
  }
  return c;
}

TEST(SpectrumPeaks, FindsAWeakOscillationWithinHalfTheResolution) {
  for (const double frequency_hz : {0.73, 3.21, 17.7}) {
    const Campaign c = campaign(frequency_hz, 0.01, 0);
    const auto peaks = spectrum_peaks(c.records, c.residual_mm);
    ASSERT_FALSE(peaks.empty());
    EXPECT_NEAR(peaks.front().frequency_hz, frequency_hz, 1.0 / 120 / 2) << frequency_hz;
  }
}

TEST(SpectrumPeaks, StrongestLineRemoves65PercentOfTheMeanSquare) {
  // If the spectral line is subtracted from the residual, at least 65 % of the mean square must disappear.
  Campaign c = campaign(3.21, 0.2, 0);
  const Line line = spectrum_peaks(c.records, c.residual_mm).front();
  double before = 0, after = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < c.residual_mm[k].size(); ++i) {
      const double turn =
          2 * std::numbers::pi * line.frequency_hz * (c.records[k].campaign_time_s + c.records[k].time_s[i]);
      const double r = c.residual_mm[k][i];
      before += r * r;
      after += std::pow(r - line.sine_mm * std::sin(turn) - line.cosine_mm * std::cos(turn), 2);
    }
  }
  EXPECT_LT(after, 0.35 * before);
}

TEST(SpectrumPeaks, FrequencyIsFoundDespiteIrregularSamplesAndGaps) {
  Campaign c = campaign(2.4, 0.02, 0.004);
  for (std::size_t i = 1000; i < 1200; ++i) c.residual_mm[0][i] = std::nan("");
  EXPECT_NEAR(spectrum_peaks(c.records, c.residual_mm).front().frequency_hz, 2.4, 1.0 / 120 / 2);
}

TEST(SpectrumPeaks, SlowZeroDriftIsNoOscillation) {
  const Campaign c = campaign(0.05, 2.0, 0);
  for (const Line& peak : spectrum_peaks(c.records, c.residual_mm)) EXPECT_GE(peak.frequency_hz, 0.2 - 1e-9);
}

TEST(SpectrumPeaks, ALineOfTheDriveIsNoIndependentOscillation) {
  const auto is_found = [](double frequency_hz, double drive_hz) {
    const Campaign c = campaign(frequency_hz, 0.2, 0, drive_hz);
    const std::vector<Line> lines = spectrum_peaks(c.records, c.residual_mm);
    EXPECT_EQ(lines.size(), 3U);
    return std::any_of(lines.begin(), lines.end(),
                       [&](const Line& line) { return std::abs(line.frequency_hz - frequency_hz) < 0.03; });
  };
  for (const double drive_hz : {0.31, 1.27}) {
    EXPECT_FALSE(is_found(drive_hz, drive_hz)) << drive_hz;
    EXPECT_TRUE(is_found(1.1 * drive_hz, drive_hz)) << drive_hz;
  }
}

}  // namespace
}  // namespace softgrip::sysid::spectrum_peaks_test
