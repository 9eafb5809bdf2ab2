#include "drivers/board/channel_wiring.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/drivers/modbus/two_fingers.h"

namespace softgrip::drivers::channel_wiring_test {
namespace {

BoardMap map_of_two_outputs() {
  BoardMap map;
  map.name = "test board";
  map.inputs.registers.count = 6;
  map.outputs.registers.count = 2;
  return map;
}

TEST(ChannelWiring, AcceptsTwoValidChannels) {
  EXPECT_TRUE(wiring_problems(map_of_two_outputs(), test::two_fingers()).empty());
}

TEST(ChannelWiring, EachMistakeCausesOneProblemThatNamesTheChannel) {
  using Mistake = std::function<void(std::vector<ChannelWiring>&)>;
  const std::vector<std::pair<Mistake, std::string>> mistakes{
      {[](auto& w) { w[1].valve.output = 2; }, "no output 2"},
      {[](auto& w) { w[1].valve.output = 0; }, "output 0 is wired twice"},
      {[](auto& w) { w[1].displacement.input = 6; }, "no input 6"},
      {[](auto& w) { w[1].pressure->input = 4; }, "input 4 is wired twice"},
      {[](auto& w) { w[1].displacement.unit = ElectricalUnit::milliampere; }, "the wiring states mA"},
      {[](auto& w) { w[1].valve.scaling.x1 = 0; }, "scaling points"},
      {[](auto& w) { w[1].displacement.scaling.y1 = -5; }, "scaling points"},
      {[](auto& w) { w[1].displacement.valid_max = 0.1; }, "below the highest valid signal"},
      {[](auto& w) { w[1].displacement.error_codes[0].tolerance = -1; }, "tolerance"},
  };
  for (const auto& [make, expected] : mistakes) {
    std::vector<ChannelWiring> wiring = test::two_fingers();
    make(wiring);
    const std::vector<std::string> problems = wiring_problems(map_of_two_outputs(), wiring);
    ASSERT_EQ(problems.size(), 1U) << expected;
    EXPECT_NE(problems[0].find(expected), std::string::npos) << problems[0];
    EXPECT_NE(problems[0].find("right"), std::string::npos) << problems[0];
  }
  EXPECT_EQ(wiring_problems(map_of_two_outputs(), {}).size(), 1U);
}

TEST(ChannelWiring, ChannelsMayShareOnlyATemperatureInput) {
  std::vector<ChannelWiring> wiring = test::two_fingers_and_a_thermometer();
  EXPECT_TRUE(wiring_problems(map_of_two_outputs(), wiring).empty());
  wiring[1].temperature->valid_max = 0;
  ASSERT_EQ(wiring_problems(map_of_two_outputs(), wiring).size(), 1U);
  wiring[1].temperature->input = wiring[0].displacement.input;
  wiring[1].temperature->valid_max = 10;
  const auto problems = wiring_problems(map_of_two_outputs(), wiring);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].find("input 0 is wired twice"), std::string::npos) << problems[0];
}

}  // namespace
}  // namespace softgrip::drivers::channel_wiring_test
