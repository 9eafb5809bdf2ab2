#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "control/sequences/prepare_sequence.h"
#include "control/sequences/sequence_file.h"
#include "control/tick/sequence.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control {
namespace {

TEST(Profile, IsLinearBetweenPointsAndJumpsWhereTwoShareATime) {
  Profile profile;
  profile.points = {{0, 0}, {1, 10}, {1, 20}, {3, 0}};
  EXPECT_EQ(value_at(profile, -1), 0);
  EXPECT_EQ(value_at(profile, 0.5), 5);
  EXPECT_EQ(value_at(profile, 1), 20);
  EXPECT_EQ(value_at(profile, 2), 10);
  EXPECT_EQ(value_at(profile, 9), 0);
  EXPECT_EQ(duration_s(profile), 3);
}

TEST(Profile, RepeatsItsCycle) {
  Profile profile;
  profile.points = {{0, 0}, {1, 10}, {2, 0}};
  profile.cycles = 3;
  EXPECT_EQ(duration_s(profile), 6);
  for (double t = 0; t < 2; t += 0.1) {
    EXPECT_NEAR(value_at(profile, t), value_at(profile, t + 4), 1e-12);
  }
  EXPECT_EQ(value_at(profile, 6), 0);
}

TEST(Profile, OfASignalIsTheSignalScaled) {
  Profile profile;
  profile.signal = model::SignalName::tp2;
  profile.scale = 0.5;
  profile.cycles = 2;
  const double one = model::duration_s(model::SignalName::tp2);
  EXPECT_EQ(duration_s(profile), 2 * one);
  EXPECT_EQ(value_at(profile, 3.2), 0.5 * model::value_kpa(model::SignalName::tp2, 3.2));
  EXPECT_NEAR(value_at(profile, one + 3.2), value_at(profile, 3.2), 1e-9);
}

struct Misfit {
  const char* what;
  const char* steps;
  const char* message;
};

class MisfitSequence : public testing::TestWithParam<Misfit> {};

TEST_P(MisfitSequence, IsRefusedAtItsStep) {
  RigSettings settings = two_finger_settings();
  settings.channels[1].displacement_used = false;  // right is blind
  settings.channels[0].pressure_measured = false;  // left measures no pressure
  document::Problems problems;
  const std::string text = std::string("name: x\nsteps:\n") + GetParam().steps;
  const auto sequence = read_sequence(document::parse("seq.yaml", text, problems), problems);
  ASSERT_TRUE(sequence) << problems.format();
  EXPECT_FALSE(prepare(*sequence, settings, problems));
  const std::string all = problems.format();
  EXPECT_NE(all.find(GetParam().message), std::string::npos) << all;
  EXPECT_NE(all.find("seq.yaml:"), std::string::npos);
  EXPECT_GE(problems.list().front().at.line, 3);
}

std::string name_of_misfit(const testing::TestParamInfo<Misfit>& test) {
  return test.param.what;
}

INSTANTIATE_TEST_SUITE_P(
    , MisfitSequence,
    testing::Values(
        Misfit{"unknown_channel", "  - move: {channels: [lefd], pressure_kpa: 5, duration_s: 1}\n",
               "did you mean 'left'?"},
        Misfit{"too_much_pressure", "  - move: {pressure_kpa: 61, duration_s: 1}\n", "allows 0 to 60 kPa"},
        Misfit{"too_far", "  - move: {channels: [left], displacement_mm: 36, duration_s: 1}\n",
               "allows -1 to 35 mm"},
        Misfit{"sine_too_far",
               "  - move: {channels: [left], displacement_mm: 20, duration_s: 1}\n"
               "  - track: {channels: [left], mean_mm: 28, amplitude_mm: 8, frequency_hz: 0.1, cycles: 1}\n",
               "goes to 36 mm"},
        Misfit{"sine_from_elsewhere",
               "  - move: {channels: [left], displacement_mm: 5, duration_s: 1}\n"
               "  - track: {channels: [left], mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.1, cycles: 1}\n",
               "displacement_mm: 6 before it"},
        Misfit{"sine_too_fast",
               "  - move: {channels: [left], displacement_mm: 6, duration_s: 1}\n"
               "  - track: {channels: [left], mean_mm: 13, amplitude_mm: 7, frequency_hz: 11, cycles: 1}\n",
               "twentieth"},
        Misfit{"blind_displacement", "  - move: {channels: [right], displacement_mm: 6, duration_s: 1}\n",
               "does not use its displacement"},
        Misfit{"blind_detection",
               "  - grip: {channels: [right], pressure_kpa: 40, settle_s: 0.1, verify: {by: detection, "
               "window_s: 0.2}, "
               "timeout_s: 3, on_fail: vent}\n",
               "verify by: pressure"},
        Misfit{"unmeasured_pressure",
               "  - grip: {channels: [left], pressure_kpa: 40, settle_s: 0.1, verify: {by: pressure, "
               "window_s: 0.2, "
               "pressure_min_kpa: 30}, timeout_s: 3, on_fail: vent}\n",
               "does not measure it"},
        Misfit{"hold_of_nothing", "  - hold: {hold_s: 1, reverify_every_s: 0.2, on_fail: vent}\n",
               "no step before has gripped"},
        Misfit{"impossible_timeout",
               "  - grip: {channels: [left], pressure_kpa: 40, duration_s: 2, settle_s: 1, verify: {by: "
               "detection, "
               "window_s: 0.5}, timeout_s: 3.5, on_fail: vent}\n",
               "not longer than the step's own times, 3.5 s"},
        Misfit{"loud_signal", "  - pressure: {signal: tp1, scale: 2}\n", "kPa"},
        Misfit{"loud_points",
               "  - pressure: {points: [{time_s: 0, pressure_kpa: 0}, {time_s: 1, pressure_kpa: 70}]}\n",
               "goes to 70 kPa"}),
    name_of_misfit);

TEST(Prepare, ChannelsAreThoseOfTheStepElseOfTheSequenceElseAll) {
  const RigSettings settings = two_finger_settings();
  const PreparedSequence sequence = sequence_of(R"(
name: x
channels: [right]
steps:
  - move: {pressure_kpa: 5, duration_s: 1}
)",
                                                settings);
  EXPECT_EQ(sequence.channels, 0b10U);
  EXPECT_EQ(example_sequence("pick_stone", settings).channels, 0b11U);
  document::Problems problems;
  const auto mixed = read_sequence(
      document::parse("x.yaml",
                      "name: x\nchannels: [right]\nsteps:\n  - move: {channels: [left], pressure_kpa: 5}\n",
                      problems),
      problems);
  ASSERT_TRUE(mixed);
  EXPECT_FALSE(prepare(*mixed, settings, problems));
}

TEST(Prepare, ReleaseGoesForwardOnly) {
  const RigSettings settings = two_finger_settings();
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_EQ(pick.steps.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(pick.steps[i].release_step, 3U);
  }
  EXPECT_EQ(pick.steps[3].release_step, 4U) << "nowhere";
}

TEST(Prepare, TheKeyOfARigChangesWithWhatASequenceDependsOn) {
  const RigSettings one = two_finger_settings();
  RigSettings other = one;
  EXPECT_EQ(rig_key(one), rig_key(other));
  other.channels[1].limits.displacement_max_mm = 34;
  EXPECT_NE(rig_key(one), rig_key(other));
  other = one;
  other.channels[1].name = "thumb";
  EXPECT_NE(rig_key(one), rig_key(other));
}

}  // namespace
}  // namespace softgrip::control
