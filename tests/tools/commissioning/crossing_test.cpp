#include "tools/commissioning/motion.h"

#include <gtest/gtest.h>

#include "rig/rig_file.h"
#include "tests/daemon/rig_under_test.h"

namespace softgrip::tools::doctor::crossing_test {
namespace {

constexpr double moved_mm = 6;
constexpr double step_kpa = 15;

/// Observations when each finger is moved alone. `sensors[i]` and `monitors[i]` are the indices of the
/// channels whose inputs respond when finger i is moved; -1: no channel responds.
struct World {
  std::vector<int> sensors;
  std::vector<int> monitors;
};

class CrossingTest : public ::testing::Test {
 protected:
  explicit CrossingTest(std::size_t channels = 3) {
    while (rig_.settings.channels.size() < channels) {
      rig_.settings.channels.push_back(rig_.settings.channels.back());
      rig_.settings.channels.back().name = "third";
      rig_.wiring.push_back(rig_.wiring.back());
      rig_.wiring.back().name = "third";
      rig_.wiring.back().displacement.input = 2;
      rig_.wiring.back().pressure->input = 3;
      rig_.wiring.back().valve.output = 2;
    }
  }
  std::vector<Crossing> find(const World& world) {
    const std::size_t count = world.sensors.size();
    rest_.assign(count, ChannelSample{});
    for (ChannelSample& sample : rest_) {
      sample.displacement_mm = sample.pressure_kpa = {.count = 100, .mean = 0, .deviation = 0.03};
    }
    std::vector<Motion> motions(count);
    for (std::size_t i = 0; i < count; ++i) {
      motions[i].command_kpa = step_kpa;
      motions[i].model_mm = moved_mm;
      motions[i].up = rest_;
      if (world.sensors[i] >= 0)
        motions[i].up[static_cast<std::size_t>(world.sensors[i])].displacement_mm.mean = 5.9;
      if (world.monitors[i] >= 0)
        motions[i].up[static_cast<std::size_t>(world.monitors[i])].pressure_kpa.mean = 15;
    }
    return find_crossings(rig_, rest_, motions);
  }
  Finding told(const std::vector<Crossing>& crossings) {
    Findings findings;
    tell_crossings(rig_, crossings, findings);
    EXPECT_EQ(findings.list().size(), 1U);
    return findings.list().empty() ? Finding{} : findings.list().front();
  }

  rig::RigFile rig_ = daemon::testing::example_rig("rig.yaml");
  std::vector<ChannelSample> rest_;
};

TEST_F(CrossingTest, FindsNoSwapOnAHealthyRigOrWithAStuckSensor) {
  EXPECT_TRUE(find({{0, 1}, {0, 1}}).empty());
  EXPECT_TRUE(find({{0, -1}, {0, 1}}).empty()) << "one of the sensors is stuck";
  EXPECT_TRUE(find({{1, 1}, {0, 1}}).empty()) << "one sensor follows both fingers, so there is no swap";
  EXPECT_TRUE(find({{1, -1}, {0, 1}}).empty()) << "the responses do not form a swap of channels";
}

TEST_F(CrossingTest, ASwapOfTwoSensorsIsReportedWithTheInputs) {
  const auto crossings = find({{1, 0}, {0, 1}});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].kind, Crossing::Kind::sensors);
  EXPECT_TRUE(is_crossed(crossings, Crossing::Kind::sensors, 1));
  EXPECT_FALSE(is_crossed(crossings, Crossing::Kind::monitors, 1));
  const Finding finding = told(crossings);
  EXPECT_EQ(finding.name, "sensors left, right");
  EXPECT_EQ(finding.text,
            "crossed: when `left` was moved, the sensor of `right` responded; when `right` was moved, the "
            "sensor of "
            "`left` responded");
  EXPECT_NE(finding.advice.find("swap input 0 (`left`) and input 1 (`right`)"), std::string::npos);
  EXPECT_NE(finding.advice.find("under `sensor` in the rig file"), std::string::npos);
}

TEST_F(CrossingTest, ASwapOfTwoPressureMonitorsIsReportedWithTheInputs) {
  const auto crossings = find({{0, 1}, {1, 0}});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].kind, Crossing::Kind::monitors);
  const Finding finding = told(crossings);
  EXPECT_EQ(finding.name, "monitors left, right");
  EXPECT_NE(finding.advice.find("swap input 4 (`left`) and input 5 (`right`)"), std::string::npos)
      << finding.advice;
}

TEST_F(CrossingTest, SwappedSensorsAndMonitorsTogetherMeanSwappedValves) {
  const auto crossings = find({{1, 0}, {1, 0}});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].kind, Crossing::Kind::valves);
  EXPECT_NE(told(crossings).advice.find("swap output 0 (`left`) and output 1 (`right`)"), std::string::npos);
}

TEST_F(CrossingTest, FindsACyclicSwapOfThreeSensors) {
  const auto crossings = find({{1, 2, 0}, {0, 1, 2}});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].channels, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_NE(told(crossings).advice.find("input 0 (`left`), input 1 (`right`) and input 2 (`third`)"),
            std::string::npos);
}

TEST_F(CrossingTest, ASwapDoesNotIncludeCorrectlyConnectedChannels) {
  const auto crossings = find({{1, 0, 2}, {0, 1, 2}});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_FALSE(is_crossed(crossings, Crossing::Kind::sensors, 2));
}

}  // namespace
}  // namespace softgrip::tools::doctor::crossing_test
