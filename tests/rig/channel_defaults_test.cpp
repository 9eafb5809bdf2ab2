// Tests the key `channel_defaults` of a rig file. This key contains the settings that all channels share.

#include "rig/rig_file_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "rig/rig_file.h"
#include "tests/support/files.h"

namespace softgrip::rig::channel_defaults_test {
namespace {

using document::Problems;

const std::string path = std::string(SOFTGRIP_SOURCE_DIR) + "/config/rig.yaml";

class ChannelDefaultsTest : public ::testing::Test {
 protected:
  ChannelDefaultsTest() { text = test::text_of(path); }
  void change(const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  std::optional<RigFile> read() {
    problems = {};
    return read_rig(document::parse(path, text, problems), problems);
  }
  /// Returns the number of the first line of the text that contains `words`.
  [[nodiscard]] int line_of(const std::string& words) const {
    return 1 + static_cast<int>(std::count(
                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(words)), '\n'));
  }
  std::string text;
  Problems problems;
};

TEST_F(ChannelDefaultsTest, OmittedKeysComeFromTheChannelDefaults) {
  const auto rig = read();
  ASSERT_TRUE(rig) << problems.format();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(rig->settings.channels[i].model.name, "bench_twin");
    EXPECT_EQ(rig->settings.channels[i].limits.pressure_max_kpa, 60);
    EXPECT_EQ(rig->wiring[i].valve.output, i);
    EXPECT_EQ(rig->wiring[i].valve.scaling, (drivers::TwoPoints{0, 0, 10, 100}));
    EXPECT_EQ(rig->wiring[i].pressure->input, 4 + i);
  }
}

TEST_F(ChannelDefaultsTest, OneTemperatureSensorServesAllChannels) {
  const std::string sensor =
      "  temperature_sensor: {input: 7, at_v: [0, 10], is_c: [-20, 80], valid_v: [0.1, 9.9]}\n";
  change("channel_defaults:", "    # the same\nchannel_defaults:");
  change("  model: models/bench_twin.yaml   #", sensor + "  model: models/bench_twin.yaml   #");
  change("        pressure_noise_kpa: 0.1\n",
         "        pressure_noise_kpa: 0.1\n        temperature_c: 26.5\n");
  const auto rig = read();
  ASSERT_TRUE(rig) << problems.format();
  for (const drivers::ChannelWiring& channel : rig->wiring) {
    ASSERT_TRUE(channel.temperature);
    EXPECT_EQ(channel.temperature->input, 7U);
    EXPECT_EQ(channel.temperature->scaling, (drivers::TwoPoints{0, -20, 10, 80}));
  }
  const auto& board = std::get<simulation::SimulatedBoardSettings>(rig->board);
  EXPECT_TRUE(board.channels[1].measures_temperature);
  EXPECT_EQ(board.channels[0].plant.temperature_c, 26.5);
  EXPECT_EQ(board.channels[1].plant.temperature_c, 20);
}

TEST_F(ChannelDefaultsTest, ATemperatureSensorCannotShareASensorInput) {
  change("    sensor: {input: 1}",
         "    sensor: {input: 1}\n"
         "    temperature_sensor: {input: 0, at_v: [0, 10], is_c: [-20, 80], valid_v: [0.1, 9.9]}");
  EXPECT_FALSE(read());
  EXPECT_NE(problems.format().find("the input 0 is already"), std::string::npos) << problems.format();
}

TEST_F(ChannelDefaultsTest, KeysOfAChannelOverrideSingleDefaults) {
  change("  - name: right\n", "  - name: right\n    feedforward: none\n    limits: {pressure_max_kpa: 40}\n");
  change("    sensor: {input: 1}", "    sensor: {input: 1, is_mm: [45, -5]}");
  const auto rig = read();
  ASSERT_TRUE(rig) << problems.format();
  const control::ChannelSettings& right = rig->settings.channels[1];
  EXPECT_EQ(right.feedforward.kind, control::FeedforwardKind::none);
  EXPECT_EQ(right.limits.pressure_max_kpa, 40);
  EXPECT_EQ(right.limits.slew_up_kpa_per_s, 300) << "the value must be that of channel_defaults";
  EXPECT_EQ(rig->wiring[1].displacement.scaling, (drivers::TwoPoints{0, 45, 10, -5}));
  EXPECT_EQ(rig->wiring[1].displacement.valid_max, 9.9);
  EXPECT_EQ(rig->settings.channels[0].limits.pressure_max_kpa, 60);
}

TEST_F(ChannelDefaultsTest, AnErrorInADefaultIsReportedOnceAtTheLine) {
  change("kp_kpa_per_mm: 2.7", "kp_kpa_per_mm: fast");
  change("slew_up_kpa_per_s: 300", "slew_up_mpa_per_s: 0.3");
  change("at_v: [0, 10], is_mm: [-5, 45]", "at_v: [0, x], is_mm: [-5, 45]");
  EXPECT_FALSE(read());
  ASSERT_EQ(problems.size(), 3U) << problems.format();
  EXPECT_EQ(problems.list()[0].at.line, line_of("kp_kpa_per_mm: fast"));
  EXPECT_EQ(problems.list()[1].at.line, line_of("slew_up_mpa_per_s"));
  EXPECT_EQ(problems.list()[2].at.line, line_of("is_mm: [-5, 45]"));
  EXPECT_NE(problems.format().find("`slew_up_kpa_per_s`"), std::string::npos) << problems.format();
}

TEST_F(ChannelDefaultsTest, AMissingSharedKeyIsReportedOnce) {
  change("    displacement_margin_mm: 2\n", "");
  EXPECT_FALSE(read());
  EXPECT_EQ(problems.size(), 1U) << problems.format();
}

TEST_F(ChannelDefaultsTest, MissingOwnKeysAreReportedForEachChannel) {
  change("    valve: {output: 0}\n", "    valve: {}\n");
  change("    valve: {output: 1}\n", "    valve: {}\n");
  EXPECT_FALSE(read());
  EXPECT_EQ(problems.size(), 2U) << problems.format();
}

TEST_F(ChannelDefaultsTest, ADefaultThatMustBeAMapIsRefusedAsText) {
  change("  valve: {at_v: [0, 10], is_kpa: [0, 100], range_kpa: [0, 100], on_power_loss: vents}\n",
         "  valve: big\n");
  EXPECT_FALSE(read());
  EXPECT_NE(problems.format().find("`valve` of `channel_defaults` must be a map"), std::string::npos)
      << problems.format();
}

TEST_F(ChannelDefaultsTest, NameAndModelHealthAreRefusedAsDefaults) {
  change("channel_defaults:", "channel_defaults:\n  name: both\n  model_health: {noise_mm: 1}\n#");
  text.replace(text.find("\n#"), 2, "\n  # ");
  EXPECT_FALSE(read());
  EXPECT_NE(problems.format().find("channels cannot share a name"), std::string::npos) << problems.format();
  EXPECT_NE(problems.format().find("`model_health` for all channels belongs to the top level of the file"),
            std::string::npos);
  EXPECT_EQ(problems.size(), 2U) << problems.format();
}

TEST_F(ChannelDefaultsTest, ChannelDefaultsMustBeAMap) {
  change("channel_defaults:                  # shared", "channel_defaults: none\nrest_of_it:   # shared");
  EXPECT_FALSE(read());
  EXPECT_NE(problems.format().find("`channel_defaults` must be a map of keys, found `none`"),
            std::string::npos)
      << problems.format();
}

TEST_F(ChannelDefaultsTest, AFileWithoutChannelDefaultsIsRead) {
  const std::size_t from = text.find("channel_defaults:");
  const std::size_t to = text.find("channels:\n");
  std::string shared = text.substr(text.find('\n', from) + 1, to - text.find('\n', from) - 2);
  text.erase(from, to - from);
  for (const char* const key : {"  valve:", "  sensor:", "  pressure_monitor:"})
    shared.erase(shared.find(key), shared.find('\n', shared.find(key)) + 1 - shared.find(key));
  std::string own;
  std::istringstream lines(shared);
  for (std::string line; std::getline(lines, line);) own += "  " + line + "\n";
  for (const std::string name : {"left", "right"})
    change("  - name: " + name + "\n", "  - name: " + name + "\n" + own);
  for (const std::string number : {"0", "1"}) {
    change("valve: {output: " + number + "}",
           "valve: {output: " + number +
               ", at_v: [0, 10], is_kpa: [0, 100], range_kpa: [0, 100], on_power_loss: vents}");
    change("sensor: {input: " + number + "}",
           "sensor: {input: " + number + ", at_v: [0, 10], is_mm: [-5, 45], valid_v: [0.1, 9.9]}");
  }
  for (const std::string number : {"4", "5"}) {
    change("pressure_monitor: {input: " + number + "}",
           "pressure_monitor: {input: " + number + ", at_v: [0, 10], is_kpa: [0, 100], valid_v: [-0.2, 10]}");
  }
  const auto rig = read();
  ASSERT_TRUE(rig) << problems.format() << text;
  EXPECT_EQ(rig->settings.channels[1].limits.displacement_max_mm, 35);
}

}  // namespace
}  // namespace softgrip::rig::channel_defaults_test
