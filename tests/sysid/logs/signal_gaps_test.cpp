#include "sysid/logs/signal_gaps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::signal_gaps_test {
namespace {

/// Returns 20 s of triangles between holds, sampled at 50 Hz, with readings of a resolution of `resolution`.
Log triangles(double resolution) {
  Log log;
  for (int i = 0; i < 1000; ++i) {
    const double share = std::min(1.0, std::abs(i % 400 - 200) / 100.0);  // hold, fall, rise, hold
    log.time_s.push_back(0.02 * i);
    log.pressure_command_kpa.push_back(60 * share);
    const double noise = 0.004 * ((i * 7919) % 11 - 5);
    log.displacement_mm.push_back(resolution * std::round((20 * share + noise) / resolution));
    log.pressure_kpa.push_back(resolution * std::round((60 * share + noise) / resolution));
  }
  return log;
}

/// Returns the log without the measured pressures of the samples [first, last).
Log without_pressure(std::size_t first, std::size_t last) {
  Log log = triangles(0.001);
  for (std::size_t i = first; i < last; ++i) log.pressure_kpa[i] = std::nan("");
  return log;
}

TEST(SignalGaps, PressureIsMissingWhileTheCommandChanges) {
  const Log log = without_pressure(120, 170);
  const auto gap = pressure_gap(log);
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->first, 119U);
  EXPECT_EQ(gap->last, 170U);
  EXPECT_NEAR(gap->length_s, 1.02, 1e-9);
  EXPECT_NEAR(gap->change_kpa, 30.6, 1e-9);
  EXPECT_EQ(gap_sentence(log, *gap),
            "a gap of 1.02 s in the measured pressure, from 2.38 s to 3.4 s, in which the command changed by "
            "30.6 kPa");
  const auto at_end = pressure_gap(without_pressure(880, 1000));
  ASSERT_TRUE(at_end) << "the last pressure would be used until the end of the log";
  EXPECT_EQ(at_end->last, 999U);
  EXPECT_TRUE(pressure_gap(without_pressure(0, 150)));
}

TEST(SignalGaps, AShortIntervalOrAConstantCommandIsNoGap) {
  EXPECT_FALSE(pressure_gap(triangles(0.001)));
  EXPECT_FALSE(pressure_gap(without_pressure(120, 140))) << "0.42 s";
  EXPECT_FALSE(pressure_gap(without_pressure(10, 95))) << "the command is constant";
  Log slow = triangles(0.001);
  for (std::size_t i = 0; i < slow.size(); ++i) {
    if (i % 40 != 0) slow.pressure_kpa[i] = std::nan("");
  }
  EXPECT_FALSE(pressure_gap(slow)) << "the pressure is measured every 0.8 s";
  Log unmeasured = triangles(0.001);
  unmeasured.pressure_kpa.clear();
  EXPECT_FALSE(pressure_gap(unmeasured));
}

/// Returns the frozen range of the readings, if the readings of the samples [first, last) are constant.
std::optional<SignalGap> frozen(double resolution, std::size_t first, std::size_t last) {
  Log log = triangles(resolution);
  for (std::size_t i = first; i < last; ++i) log.displacement_mm[i] = log.displacement_mm[first];
  return frozen_range(log, log.displacement_mm);
}

TEST(SignalGaps, FrozenValuesAreFound) {
  for (const double resolution : {0.001, 0.01, 0.1}) {
    const auto range = frozen(resolution, 130, 250);
    ASSERT_TRUE(range) << resolution;
    EXPECT_NEAR(static_cast<double>(range->first), 130, 1) << resolution;
    EXPECT_NEAR(static_cast<double>(range->last), 249, 1) << resolution;
    EXPECT_GT(range->change_kpa, 10);
  }
}

TEST(SignalGaps, ReadingsOfLowResolutionAreNotFrozen) {
  for (const double resolution : {0.001, 0.01, 0.1, 1.0, 5.0}) {
    const Log log = triangles(resolution);
    EXPECT_FALSE(frozen_range(log, log.displacement_mm)) << resolution;
    EXPECT_FALSE(frozen_range(log, log.pressure_kpa)) << resolution;
  }
  EXPECT_FALSE(frozen(0.001, 130, 145)) << "only 15 equal readings";
}

TEST(SignalGaps, ValuesOfASlowSensorAreNotFrozen) {
  const auto slow = [](std::size_t last) {
    Log log = triangles(0.001);
    for (std::size_t i = 0; i < log.size(); ++i)
      log.displacement_mm[i] = log.displacement_mm[i >= 120 && i < last ? 120 : i - i % 10];
    return frozen_range(log, log.displacement_mm);
  };
  EXPECT_FALSE(slow(270)) << "15 times the usual number of equal values";
  EXPECT_TRUE(slow(420)) << "30 times the usual number of equal values";
}

}  // namespace
}  // namespace softgrip::sysid::signal_gaps_test
