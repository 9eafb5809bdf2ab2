#include "tests/control/settings_fixture.h"

#include <gtest/gtest.h>

#include "control/sequences/sequence_file.h"
#include "model/file/model_file.h"

namespace softgrip::control {

const model::Model& twin() {
  static const model::Model model = [] {
    document::Problems problems;
    const auto loaded = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
    EXPECT_TRUE(loaded) << problems.format();
    return loaded.value_or(model::Model{});
  }();
  return model;
}

RigSettings two_finger_settings() {
  ChannelSettings channel;
  channel.model = twin();
  channel.pid.kp_kpa_per_mm = 0.3;
  channel.pid.ki_kpa_per_mm_s = 1;
  channel.feedforward.kind = FeedforwardKind::full_model;
  channel.limits = {0, 60, 300, 600, -1, 35, 2};
  channel.pressure_measured = true;
  RigSettings settings;
  settings.rate_hz = 200;
  for (const char* name : {"left", "right"}) {
    channel.name = name;
    settings.channels.push_back(channel);
  }
  settings.safety.safe_action = {SafeAction::vent, SafeAction::vent, SafeAction::hold, SafeAction::vent};
  settings.detection.margin_mm = 1;
  settings.rest_band_mm = 0.3;
  EXPECT_EQ(settings_problems(settings), std::vector<std::string>{});
  return settings;
}

RigSettings vacuum_settings() {
  RigSettings settings = two_finger_settings();
  for (ChannelSettings& channel : settings.channels) channel.limits = {-40, 60, 300, 600, -30, 35, 2, 0};
  EXPECT_EQ(settings_problems(settings), std::vector<std::string>{});
  return settings;
}

PreparedSequence vacuum_grip(const RigSettings& settings) {
  return example_sequence("../vacuum/sequences/vacuum_grip", settings);
}

PreparedSequence sequence_of(const std::string& yaml, const RigSettings& settings) {
  document::Problems problems;
  const auto sequence = read_sequence(document::parse("test.yaml", yaml, problems), problems);
  const auto prepared = sequence ? prepare(*sequence, settings, problems) : std::nullopt;
  EXPECT_TRUE(prepared) << problems.format();
  return prepared.value_or(PreparedSequence{});
}

PreparedSequence example_sequence(const std::string& name, const RigSettings& settings) {
  document::Problems problems;
  const auto sequence = load_sequence(SOFTGRIP_SOURCE_DIR "/config/sequences/" + name + ".yaml", problems);
  const auto prepared = sequence ? prepare(*sequence, settings, problems) : std::nullopt;
  EXPECT_TRUE(prepared) << problems.format();
  return prepared.value_or(PreparedSequence{});
}

}  // namespace softgrip::control
