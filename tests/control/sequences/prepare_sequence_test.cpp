#include <gtest/gtest.h>

#include <optional>
#include <stop_token>
#include <string>

#include "control/sequences/sequence_file.h"
#include "control/tick/sequence.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control::prepare_sequence_test {
namespace {

TEST(Profile, IsLinearBetweenPointsAndJumpsAtEqualTimes) {
  Profile profile;
  profile.points = {{0, 0}, {1, 10}, {1, 20}, {3, 0}};
  EXPECT_EQ(value_at(profile, -1), 0);
  EXPECT_EQ(value_at(profile, 0.5), 5);
  EXPECT_EQ(value_at(profile, 1), 20);
  EXPECT_EQ(value_at(profile, 2), 10);
  EXPECT_EQ(value_at(profile, 9), 0);
  EXPECT_EQ(duration_s(profile), 3);
}

TEST(Profile, AProfileWithFewerThan2PointsIsConstant) {
  Profile profile;
  EXPECT_EQ(duration_s(profile), 0);
  EXPECT_EQ(value_at(profile, 1), 0);
  profile.points = {{0, 7}};
  EXPECT_EQ(duration_s(profile), 0);
  EXPECT_EQ(value_at(profile, 1), 7);
}

TEST(Profile, ReturnsTheFirstValueBeforeTheFirstPoint) {
  Profile profile;
  profile.points = {{1, 3}, {2, 5}};
  EXPECT_EQ(value_at(profile, 0.5), 3);
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

TEST(Profile, ASignalProfileReturnsTheScaledSignal) {
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
  settings.channels[1].displacement_used = false;  // the channel right has no displacement feedback
  settings.channels[0].pressure_measured = false;  // the channel left has no pressure monitor
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
               "above 1/20"},
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
               "does not measure the pressure"},
        Misfit{"hold_of_nothing", "  - hold: {hold_s: 1, reverify_every_s: 0.2, on_fail: vent}\n",
               "requires an earlier grip step"},
        Misfit{"impossible_timeout",
               "  - grip: {channels: [left], pressure_kpa: 40, duration_s: 2, settle_s: 1, verify: {by: "
               "detection, "
               "window_s: 0.5}, timeout_s: 3.5, on_fail: vent}\n",
               "purge_s and window_s of the step, 3.5 s"},
        Misfit{"no_grip_to_go_to",
               "  - move: {channels: [left], displacement_mm: 5, duration_s: 1, on_contact: grip}\n",
               "requires a grip step after this step"},
        Misfit{"unseen_squeeze",
               "  - grip: {channels: [left], displacement_mm: 15, duration_s: 2, squeeze_kpa: 1, "
               "squeeze_speed_kpa_per_s: 5, settle_s: 0.1, verify: {by: detection, window_s: 0.2}, "
               "timeout_s: 3, "
               "on_fail: vent}\n",
               "detects a part only if the gripping pressure is at least"},
        Misfit{"blind_squeeze",
               "  - move: {channels: [right], pressure_kpa: 10, duration_s: 1, squeeze_max_kpa: 5}\n",
               "limit the step with pressure_max_kpa instead of squeeze_max_kpa"},
        Misfit{"bound_beyond_the_rig",
               "  - move: {channels: [left], displacement_mm: 5, duration_s: 1, pressure_max_kpa: 61}\n",
               "allows 0 to 60 kPa"},
        Misfit{"target_beyond_its_bound",
               "  - move: {channels: [left], pressure_kpa: 30, duration_s: 1, pressure_max_kpa: 20}\n",
               "above the pressure_max_kpa of the step"},
        Misfit{"loud_signal", "  - pressure: {signal: tp1, scale: 2}\n", "kPa"},
        Misfit{"loud_points",
               "  - pressure: {points: [{time_s: 0, pressure_kpa: 0}, {time_s: 1, pressure_kpa: 70}]}\n",
               "goes to 70 kPa"},
        Misfit{"channel_like_no_other",
               "  - move: {channels: [thumbscrew], pressure_kpa: 5, duration_s: 1}\n",
               "the rig has no channel 'thumbscrew'"},
        Misfit{"too_little_pressure", "  - move: {pressure_kpa: -5, duration_s: 1}\n", "goes to -5 kPa"},
        Misfit{"too_near", "  - move: {channels: [left], displacement_mm: -2, duration_s: 1}\n",
               "goes to -2 mm"}),
    name_of_misfit);

TEST(Prepare, StepChannelsDefaultToSequenceChannelsThenToAll) {
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

std::optional<PreparedSequence> prepared(const std::string& steps, const RigSettings& settings,
                                         document::Problems& problems, const std::stop_token& stop = {}) {
  const auto sequence =
      read_sequence(document::parse("seq.yaml", "name: x\nsteps:\n" + steps, problems), problems);
  return sequence ? prepare(*sequence, settings, problems, stop) : std::nullopt;
}

TEST(Prepare, ValuesEqualToTheLimitsAreAccepted) {
  RigSettings settings = two_finger_settings();
  settings.rate_hz = 10;
  const char* const grip =
      "  - grip: {pressure_kpa: 40, settle_s: 0.1, verify: {by: detection, window_s: 0.2}, timeout_s: 3, "
      "on_fail: vent}\n  - hold: {hold_s: 1, reverify_every_s: 0.2, on_fail: vent}\n";
  for (const char* steps :
       {"  - move: {displacement_mm: -1, duration_s: 1}\n",
        "  - move: {displacement_mm: 35, duration_s: 1}\n", "  - move: {pressure_kpa: 0, duration_s: 1}\n",
        "  - move: {pressure_kpa: 60, duration_s: 1}\n", grip}) {
    document::Problems problems;
    EXPECT_TRUE(prepared(steps, settings, problems)) << steps << problems.format();
  }
}

TEST(Prepare, IntervalsBelowTwoPeriodsAreRefused) {
  RigSettings settings = two_finger_settings();
  settings.rate_hz = 10;
  const auto grip_and_hold = [](const char* window_s, const char* every_s) {
    return "  - grip: {pressure_kpa: 40, settle_s: 0.1, verify: {by: detection, window_s: " +
           std::string(window_s) +
           "}, timeout_s: 3, on_fail: vent}\n  - hold: {hold_s: 1, reverify_every_s: " + every_s +
           ", on_fail: vent}\n";
  };
  document::Problems window;
  EXPECT_FALSE(prepared(grip_and_hold("0.19", "0.2"), settings, window));
  EXPECT_NE(window.format().find("window_s is shorter than two periods"), std::string::npos)
      << window.format();
  document::Problems hold;
  EXPECT_FALSE(prepared(grip_and_hold("0.2", "0.19"), settings, hold));
  EXPECT_NE(hold.format().find("reverify_every_s is shorter than two periods"), std::string::npos)
      << hold.format();
}

TEST(Prepare, ADisplacementTargetRequiresFeedforwardOrGains) {
  const char* move = "  - move: {channels: [left], displacement_mm: 5, duration_s: 1}\n";
  RigSettings settings = two_finger_settings();
  settings.channels[0].feedforward.kind = FeedforwardKind::none;
  settings.channels[0].pid.kp_kpa_per_mm = settings.channels[0].pid.ki_kpa_per_mm_s = 0;
  document::Problems problems;
  EXPECT_FALSE(prepared(move, settings, problems));
  EXPECT_NE(problems.format().find("has no feedforward and no PID gains"), std::string::npos)
      << problems.format();
  settings.channels[0].pid.ki_kpa_per_mm_s = 1;
  document::Problems none;
  EXPECT_TRUE(prepared(move, settings, none)) << none.format();
  settings.channels[0].pid = {1, 0, 0, 0.02, 1, AntiWindup::back_calculation, 0.3};
  EXPECT_TRUE(prepared(move, settings, none)) << none.format();
}

TEST(Prepare, StoppedPlanningIsRefusedWithTheReason) {
  RigSettings settings = two_finger_settings();
  settings.channels[0].feedforward.kind = FeedforwardKind::planned;
  std::stop_source stop;
  stop.request_stop();
  document::Problems problems;
  EXPECT_FALSE(
      prepared("  - move: {displacement_mm: 5, duration_s: 1}\n", settings, problems, stop.get_token()));
  EXPECT_NE(problems.format().find("the planning of this step was stopped before its end"), std::string::npos)
      << problems.format();
}

TEST(Prepare, TheReleaseStepIsAlwaysALaterStep) {
  const RigSettings settings = two_finger_settings();
  const PreparedSequence pick = example_sequence("pick_stone", settings);
  ASSERT_EQ(pick.steps.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(pick.steps[i].release_step, 3U);
  }
  EXPECT_EQ(pick.steps[3].release_step, 4U) << "no step follows the release step";
}

TEST(Prepare, AParameterErrorIsReportedAtTheParameter) {
  const RigSettings settings = two_finger_settings();  // the upper pressure limit of this rig is 60 kPa
  const std::string text =
      "name: x\nparameters:\n  level_kpa: {default: 20, range: [10, 70], about: how hard}\n"
      "steps:\n  - move: {pressure_kpa: $level_kpa, duration_s: 1}\n";
  const auto read = [&](const std::vector<Argument>& arguments) {
    document::Problems problems;
    return read_sequence(document::parse("seq.yaml", text, problems), problems, arguments);
  };
  document::Problems problems;
  ASSERT_TRUE(read({}));
  EXPECT_TRUE(prepare(*read({}), settings, problems)) << "the requested value is within the limits";
  check_ranges(*read({}), settings, problems);
  ASSERT_EQ(problems.size(), 2U) << "each channel must cause one error";
  EXPECT_EQ(problems.list()[0].at.line, 3);
  EXPECT_NE(
      problems.list()[0].message.find(
          "with `level_kpa` = 70, the upper end of its range, line 5 is wrong: step 'move': goes to 70 kPa"),
      std::string::npos)
      << problems.format();

  document::Problems asked;
  EXPECT_FALSE(prepare(*read({{"level_kpa", 65}}), settings, asked));
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_EQ(asked.list()[0].at.line, 3);
  EXPECT_NE(asked.list()[0].message.find("with `level_kpa` = 65, line 5 is wrong"), std::string::npos)
      << asked.format();
}

TEST(Prepare, TheRigKeyChangesWithLimitsAndChannelNames) {
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
}  // namespace softgrip::control::prepare_sequence_test
