#include "control/feedforward/valve_inverse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/feedforward/running_model.h"
#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"

namespace softgrip::control::valve_inverse_test {
namespace {

constexpr double tick_s = 0.005;

const model::BlockSpec band = model::block_of<model::ValveDeadband>({{"band_kpa", 1.2}});
const model::BlockSpec lag = model::block_of<model::ValveLag>({{"time_constant_s", 0.044}});
const model::BlockSpec two_way_lag = model::block_of<model::AsymmetricValveLag>(
    {{"filling_time_constant_s", 0.03}, {"venting_time_constant_s", 0.06}});
const model::BlockSpec regulator =
    model::block_of<model::PressureRegulator>({{"filling_time_constant_s", 0.015},
                                               {"venting_time_constant_s", 0.022},
                                               {"overlap_kpa", 0.4},
                                               {"integral_time_s", 0.3},
                                               {"full_open_kpa", 15}});

model::Model valve_with(std::initializer_list<model::BlockSpec> blocks) {
  model::Model model;
  model.blocks = blocks;  // assigned directly, because the test depends on the order of the blocks
  return model;
}

double wanted_kpa(double t) {
  return 25 - 15 * std::cos(1.3 * t) - 5 * std::cos(4.1 * t);
}

struct Course {
  double worst_kpa = 0;           ///< largest difference between the resulting and the requested pressure
  double worst_expected_kpa = 0;  ///< largest difference between the resulting and the predicted pressure
};

/// In each tick, computes the command for a requested pressure with the inverse, and simulates the blocks
/// with this command to get the resulting pressure.
Course course_through(const model::Model& model) {
  model::Chain<double> chain(model, {}, tick_s);
  chain.reset(wanted_kpa(0));
  ValveInverse inverse(model, tick_s);
  inverse.take_over(chain);
  Course course;
  for (int k = 0; k < 4000; ++k) {
    const double next_kpa = wanted_kpa((k + 1) * tick_s), now_kpa = chain.pressure_kpa();
    const double command_kpa = inverse.command_for(now_kpa, next_kpa);
    const double expected_kpa = inverse.advance(now_kpa, command_kpa);
    chain.step(0, command_kpa);
    chain.step(tick_s, command_kpa);
    course.worst_kpa = std::max(course.worst_kpa, std::abs(chain.pressure_kpa() - next_kpa));
    course.worst_expected_kpa =
        std::max(course.worst_expected_kpa, std::abs(chain.pressure_kpa() - expected_kpa));
  }
  return course;
}

TEST(ValveInverse, TheValveReachesTheRequestedPressure) {
  struct Case {
    const char* name;
    model::Model valve;
  };
  for (const Case& test :
       {Case{"a lag", valve_with({lag})},
        Case{"a lag with a separate time constant for each direction", valve_with({two_way_lag})},
        Case{"a dead band before a lag", valve_with({band, lag})},
        Case{"a regulator", valve_with({regulator})},
        Case{"a dead band before a regulator", valve_with({band, regulator})}}) {
    const Course course = course_through(test.valve);
    EXPECT_LT(course.worst_kpa, 5e-3) << test.name;
    EXPECT_LT(course.worst_expected_kpa, 1e-9) << test.name;
  }
}

// If a lag is upstream of a dead band, the dead band has no exact inverse. The inverse must then ignore the
// dead band.
TEST(ValveInverse, ADeadBandAfterALagIsIgnored) {
  const double now_kpa = 10, next_kpa = 10.2;
  EXPECT_EQ(ValveInverse(valve_with({lag, band}), tick_s).command_for(now_kpa, next_kpa),
            ValveInverse(valve_with({lag}), tick_s).command_for(now_kpa, next_kpa));
  EXPECT_NEAR(ValveInverse(valve_with({band, lag}), tick_s).command_for(now_kpa, next_kpa),
              ValveInverse(valve_with({lag}), tick_s).command_for(now_kpa, next_kpa) + 0.6, 1e-12);
}

TEST(ValveInverse, StartsFromTheStateOfTheValve) {
  const model::Model model = valve_with({band, regulator});
  RunningModel running(model, tick_s, 0, 0.1);
  for (int k = 0; k < 400; ++k) running.advance(wanted_kpa(k * tick_s));
  ValveInverse inverse(model, tick_s);
  inverse.take_over(running.valve());
  // The inverse does not know how fast the valve vents before the first tick. The second tick must therefore
  // be more accurate than the first.
  for (const double within_kpa : {0.03, 1e-3}) {
    const double now_kpa = running.pressure_kpa(), next_kpa = now_kpa - 0.2;
    const double command_kpa = inverse.command_for(now_kpa, next_kpa);
    running.advance(command_kpa);
    EXPECT_NEAR(running.pressure_kpa(), next_kpa, within_kpa);
    EXPECT_NEAR(inverse.advance(now_kpa, command_kpa), running.pressure_kpa(), 1e-12);
  }
}

TEST(ValveInverse, ReturnsTheTimeConstantOfTheDirection) {
  const ValveInverse inverse(valve_with({two_way_lag}), tick_s);
  EXPECT_DOUBLE_EQ(inverse.time_constant_s(10, 11), 0.03);
  EXPECT_DOUBLE_EQ(inverse.time_constant_s(10, 9), 0.06);
  EXPECT_EQ(ValveInverse(valve_with({band}), tick_s).time_constant_s(10, 9), 0);
}

}  // namespace
}  // namespace softgrip::control::valve_inverse_test
