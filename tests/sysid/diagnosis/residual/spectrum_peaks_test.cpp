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

/// Half of the frequency resolution of a record of 60 s.
constexpr double half_resolution_hz = 0.5 / 60;

/// Returns two records of 60 s with an oscillation and noise. The drive oscillates with another frequency.
/// @param ahead  phase by which the oscillation of the second record is ahead of a continuation of the first
/// record [rad].
Campaign campaign(double frequency_hz, double amplitude_mm, double jitter_s, double drive_hz = 0.45,
                  double ahead = 0) {
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
      residual.push_back(amplitude_mm * std::sin(2 * std::numbers::pi * frequency_hz * t + 0.7 + ahead * k) +
                         0.04 * normal_at(9, std::uint64_t{6000} * static_cast<std::uint64_t>(k) +
                                                 static_cast<std::uint64_t>(i)));
    }
    c.records.push_back(std::move(record));
    c.residual_mm.push_back(std::move(residual));
  }
  return c;
}

/// Returns the share of the mean square that remains if the strongest line is subtracted from the residual.
double share_left(const Campaign& c) {
  const Line line = spectrum_peaks(c.records, c.residual_mm).front();
  double before = 0, after = 0;
  for (std::size_t k = 0; k < c.records.size(); ++k) {
    for (std::size_t i = 0; i < c.residual_mm[k].size(); ++i) {
      const double turn =
          2 * std::numbers::pi * line.frequency_hz *
          (c.records[k].campaign_time_s + c.records[k].time_s[i] + c.records[k].oscillation_shift_s);
      const double r = c.residual_mm[k][i];
      before += r * r;
      after += std::pow(r - line.sine_mm * std::sin(turn) - line.cosine_mm * std::cos(turn), 2);
    }
  }
  return after / before;
}

TEST(SpectrumPeaks, FindsAWeakOscillationWithinHalfTheResolution) {
  for (const double frequency_hz : {0.73, 3.21, 17.7}) {
    for (const double ahead : {0.0, 2.0, std::numbers::pi}) {
      const Campaign c = campaign(frequency_hz, 0.01, 0, 0.45, ahead);
      const auto peaks = spectrum_peaks(c.records, c.residual_mm);
      ASSERT_FALSE(peaks.empty());
      EXPECT_NEAR(peaks.front().frequency_hz, frequency_hz, half_resolution_hz) << frequency_hz;
    }
  }
}

TEST(SpectrumPeaks, StrongestLineRemoves65PercentOfTheMeanSquare) {
  Campaign one = campaign(3.21, 0.2, 0);
  one.records.pop_back();
  one.residual_mm.pop_back();
  EXPECT_LT(share_left(one), 0.35);
}

TEST(AlignedLines, OneLineDescribesRecordsWithDifferentPhases) {
  for (const double ahead : {0.0, 1.0, 2.5, -2.0, std::numbers::pi}) {
    Campaign c = campaign(3.21, 0.2, 0, 0.45, ahead);
    const AlignedLines aligned = aligned_lines(c.records, c.residual_mm);
    set_oscillation_shifts(c.records, aligned.shifts_s);
    EXPECT_LT(share_left(c), 0.35) << ahead;
    const Line of_records = spectrum_peaks(c.records, c.residual_mm).front();
    EXPECT_EQ(aligned.lines.front().sine_mm, of_records.sine_mm) << ahead;
    EXPECT_EQ(aligned.lines.front().cosine_mm, of_records.cosine_mm) << ahead;
  }
}

TEST(AlignedLines, TheCentresOfTheRecordsAreAtMostHalfAPeriodApart) {
  const Campaign c = campaign(3.21, 0.2, 0, 0.45, 2.0);
  const std::vector<double> shifts_s = aligned_lines(c.records, c.residual_mm).shifts_s;
  ASSERT_EQ(shifts_s.size(), 2U);
  EXPECT_EQ(shifts_s[0], 0);
  EXPECT_NEAR(shifts_s[1], -60, 0.5 / 3.21 + 1e-9);
}

TEST(AlignedLines, AreZeroForNoiseAndForOneRecord) {
  Campaign noise = campaign(3.21, 0, 0);
  EXPECT_EQ(aligned_lines(noise.records, noise.residual_mm).shifts_s, (std::vector<double>{0, 0}));
  Campaign one = campaign(3.21, 0.2, 0);
  one.records.pop_back();
  one.residual_mm.pop_back();
  EXPECT_EQ(aligned_lines(one.records, one.residual_mm).shifts_s, std::vector<double>{0});
}

TEST(SpectrumPeaks, FrequencyIsFoundDespiteIrregularSamplesAndGaps) {
  Campaign c = campaign(2.4, 0.02, 0.004);
  for (std::size_t i = 1000; i < 1200; ++i) c.residual_mm[0][i] = std::nan("");
  EXPECT_NEAR(spectrum_peaks(c.records, c.residual_mm).front().frequency_hz, 2.4, half_resolution_hz);
}

/// The two records last 120 s, so the slowest oscillation has a frequency of 10 / 120 Hz.
TEST(SpectrumPeaks, SlowZeroDriftIsNoOscillation) {
  const Campaign drift = campaign(0.05, 2.0, 0);
  for (const Line& peak : spectrum_peaks(drift.records, drift.residual_mm))
    EXPECT_GE(peak.frequency_hz, 10.0 / 120 - 1e-9);
  const Campaign slow = campaign(0.11, 2.0, 0);
  EXPECT_NEAR(spectrum_peaks(slow.records, slow.residual_mm).front().frequency_hz, 0.11, half_resolution_hz);
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
