#include "control/feedforward/valve_inverse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace softgrip::control::regulator_inverse_test {
namespace {

constexpr double tick_s = 0.005;
/// Parameters of a regulator: time constants for filling and venting, overlap, integral time and full
/// opening. softgrip identifies these values for textbook valves.
constexpr model::RegulatorNumbers<double> usual{0.015, 0.022, 0.4, 0.3, 15};

/// Returns the pressure at the end of a tick in which the command was held.
double held(model::RegulatedPressure<double>& regulated, double command_kpa) {
  regulated.step(model::Segment<double>::straight(tick_s, command_kpa, command_kpa),
                 [](const model::Segment<double>&) {});
  return regulated.output();
}

double wanted_kpa(double t) {
  return 25 - 15 * std::cos(1.3 * t) - 5 * std::cos(4.1 * t);
}

TEST(RegulatorInverse, ReachesTheRequestedPressureThroughTheRegulator) {
  model::RegulatedPressure<double> valve(usual);
  valve.reset(wanted_kpa(0));
  RegulatorInverse inverse(valve, tick_s);
  double worst_kpa = 0, furthest_kpa = 0;
  for (int k = 0; k < 4000; ++k) {
    const double next_kpa = wanted_kpa((k + 1) * tick_s);
    const double command_kpa = inverse.command_for(next_kpa);
    inverse.advance(command_kpa);
    const double reached_kpa = held(valve, command_kpa);
    worst_kpa = std::max(worst_kpa, std::abs(reached_kpa - next_kpa));
    furthest_kpa = std::max(furthest_kpa, std::abs(command_kpa - next_kpa));
  }
  EXPECT_LT(worst_kpa, 5e-3);
  EXPECT_GT(furthest_kpa, 1) << "the command must differ from the pressure to compensate lag, overlap and "
                                "integral action of the regulator";
}

TEST(RegulatorInverse, StartsFromTheStateOfTheRegulator) {
  model::RegulatedPressure<double> valve(usual);
  for (int k = 0; k < 100; ++k) (void)held(valve, 0.3 * k);
  ASSERT_GT(std::abs(valve.integral_kpa()), 0.1);
  RegulatorInverse inverse(model::RegulatedPressure<double>(usual), tick_s);
  inverse.take_over(valve);
  const double next_kpa = valve.output() + 0.2;
  EXPECT_NEAR(held(valve, inverse.command_for(next_kpa)), next_kpa, 1e-3);
}

TEST(RegulatorInverse, LimitsTheCommandToTheFullPortOpening) {
  model::RegulatedPressure<double> valve(usual);
  RegulatorInverse inverse(valve, tick_s);
  const double command_kpa = inverse.command_for(40);
  EXPECT_LT(command_kpa, 1.5 * usual.full_open_kpa);
  const double reached_kpa = inverse.advance(command_kpa);
  EXPECT_LT(reached_kpa, 40);
  EXPECT_NEAR(held(valve, 100), reached_kpa, 1e-9)
      << "even a command of 100 kPa would not change the pressure more in this tick";
}

// While the pressure is constant, the command must not jump between the two edges of the overlap, because
// these jumps would be useless noise.
TEST(RegulatorInverse, AConstantPressureCausesNoJumpAcrossTheOverlap) {
  const RegulatorInverse inverse(model::RegulatedPressure<double>(usual), tick_s);
  EXPECT_NEAR(inverse.command_for(1e-5) - inverse.command_for(-1e-5), 0, 0.05 * usual.overlap_kpa);
  EXPECT_EQ(direction_of(1, tick_s), 1);
  EXPECT_EQ(direction_of(-1, tick_s), -1);
  EXPECT_EQ(direction_of(0, tick_s), 0);
}

}  // namespace
}  // namespace softgrip::control::regulator_inverse_test
