#include "sysid/diagnosis/verdict/lost_pressure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace softgrip::sysid::lost_pressure_test {
namespace {

constexpr double sample_s = 0.01, noise_kpa = 0.05;

/// Returns logs of a valve without dynamics: the pressure at each sample is a function of the command at this
/// sample.
std::vector<Log> logs_of(const std::function<double(double)>& pressure_kpa) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Log log;
  for (int i = 0; i < 6400; ++i) {
    const double t = sample_s * i;
    const double u = 30 - 30 * std::cos(2 * std::numbers::pi * 0.05 * t);
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(u);
    log.displacement_mm.push_back(0);
    log.pressure_kpa.push_back(pressure_kpa(u) + noise_kpa * normal(random));
  }
  return {log};
}

std::optional<LostPressure> lost_of(const std::vector<Log>& logs) {
  const MeasuredValve valve(logs, false);
  return find_lost_pressure(logs, valve, {}, valve.fit({}, {ValveStage{}}));
}

TEST(FindLostPressure, SaysWhatIsMissingAtTheHighestPressure) {
  const auto lost = lost_of(logs_of([](double u) { return 0.97 * u; }));
  ASSERT_TRUE(lost);
  EXPECT_NEAR(lost->highest_kpa, 0.97 * 60, 5 * noise_kpa);
  EXPECT_NEAR(lost->missing_kpa, 0.03 * 60, 0.3);
  EXPECT_EQ(lost->stage.gauge_gain, 1);
  EXPECT_TRUE(lost->parts.test(index_of(ValvePart::leak)));
  EXPECT_LT(rmse_mm(lost->losses_kpa2), 0.3 * rmse_mm(lost->without_kpa2));
}

TEST(FindLostPressure, IsNothingWhereScalesMayDifferByAsMuchOrTheOtherWay) {
  for (const double scale : {0.99, 1.0, 1.05})
    EXPECT_FALSE(lost_of(logs_of([&](double u) { return scale * u; }))) << scale;
}

TEST(FindLostPressure, IsNothingWhereAConstantIsMissing) {
  EXPECT_FALSE(lost_of(logs_of([](double u) { return u - 3; })));
}

// The pressure never exceeds 52 kPa, even if the command exceeds this value. A scale error of the gauge
// explains half of the difference. A leak explains less, because the curve of a leak bends in the opposite
// direction.
TEST(FindLostPressure, IsNothingWhereTheHighestPressuresAloneAreMissing) {
  const std::vector<Log> logs = logs_of([](double u) { return std::min(u, 52.0); });
  const MeasuredValve valve(logs, false);
  ASSERT_LT(valve.fit({}, {ValveStage{}}).gauge_gain, 1 - scales_agree_within);
  EXPECT_FALSE(lost_of(logs));
}

TEST(FindLostPressure, IsNothingWhereMostOfWhatIsLeftIsSomethingElse) {
  EXPECT_FALSE(lost_of(logs_of([](double u) { return 0.97 * u + 2 * std::sin(u); })));
}

}  // namespace
}  // namespace softgrip::sysid::lost_pressure_test
