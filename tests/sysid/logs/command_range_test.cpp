#include "sysid/logs/command_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace softgrip::sysid::command_range_test {
namespace {

using Samples = std::vector<std::size_t>;

/// Returns steps between 0 and 40 kPa and slow triangles up to 60 kPa.
std::vector<double> steps_and_triangles() {
  std::vector<double> command;
  for (int i = 0; i < 200; ++i) command.push_back(i % 50 < 25 ? 40 : 0);
  for (int i = 0; i < 400; ++i) command.push_back(60 - 0.6 * std::abs(i % 200 - 100));
  return command;
}

TEST(CommandRange, WrongCommandOfASingleSampleIsAnExcursion) {
  for (const double wrong : {999.0, -300.0, 70.0}) {
    for (const std::size_t at : {1U, 60U, 110U, 350U, 598U}) {
      std::vector<double> command = steps_and_triangles();
      command[at] = wrong;
      const CommandRange range = command_range(command);
      EXPECT_EQ(range.excursions, Samples{at}) << wrong;
      EXPECT_EQ(range.lowest_kpa, 0) << wrong << " at " << at;
      EXPECT_NEAR(range.highest_kpa, 60, 0.7) << wrong << " at " << at;
    }
  }
  std::vector<double> two = steps_and_triangles();
  two[60] = two[350] = 999;
  EXPECT_EQ(command_range(two).excursions, (Samples{60, 350}));
}

TEST(CommandRange, OrdinaryCommandsHaveNoExcursion) {
  EXPECT_EQ(command_range(steps_and_triangles()).excursions, Samples{});
  std::vector<double> inside = steps_and_triangles();
  inside[60] = 50, inside[110] = 62;
  EXPECT_EQ(command_range(inside).excursions, Samples{});
  EXPECT_EQ(command_range(inside).highest_kpa, 62);
  std::vector<double> held = steps_and_triangles();
  held[60] = held[61] = 999;
  EXPECT_EQ(command_range(held).excursions, Samples{}) << "two samples are a step of the command";
  std::vector<double> triangle;
  for (int i = 0; i < 60; ++i) triangle.push_back(i % 4 == 2 ? 20 : i % 4 == 0 ? 0 : 10);
  triangle[30] = 40, triangle[29] = triangle[31] = 20;
  EXPECT_EQ(command_range(triangle).excursions, Samples{}) << "the peak of a fast triangle";
}

TEST(CommandRange, PulsesAreNoExcursionsIfTheyAreTheExcitation) {
  std::vector<double> pulses(200, 0.0);
  pulses[50] = pulses[100] = 40;
  const CommandRange range = command_range(pulses);
  EXPECT_EQ(range.excursions, Samples{});
  EXPECT_EQ(range.highest_kpa, 40);
}

}  // namespace
}  // namespace softgrip::sysid::command_range_test
