#include "control/sequences/sequence_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/files.h"
#include "tests/control/settings_fixture.h"
#include "tests/support/files.h"

namespace softgrip::control::sequence_file_test {
namespace {

std::optional<Sequence> read(const std::string& text, document::Problems& problems) {
  const auto document = document::parse("seq.yaml", text, problems);
  return read_sequence(document, problems);
}

/// Returns a sequence with one step. `step` contains this step as YAML flow text.
std::string with_step(const std::string& step) {
  return "name: x\nsteps:\n  - " + step + "\n";
}

TEST(SequenceFile, ExamplesLoadAndFitTheExampleRig) {
  for (const char* name :
       {"pick_stone", "pick_screw", "empty_grip", "track_sine", "pressure_staircase", "hand_over"}) {
    document::Problems problems;
    const auto sequence =
        load_sequence(std::string(SOFTGRIP_SOURCE_DIR "/config/sequences/") + name + ".yaml", problems);
    ASSERT_TRUE(sequence) << problems.format();
    EXPECT_EQ(sequence->name, name);
    EXPECT_TRUE(prepare(*sequence, two_finger_settings(), problems)) << problems.format();
  }
}

TEST(SequenceFile, ContactAndGrippingPressureKeysAreRead) {
  document::Problems problems;
  const auto sequence = read(R"(
name: gentle
steps:
  - move: {displacement_mm: 5, duration_s: 1}
  - move: {displacement_mm: 6, duration_s: 1, tolerance_mm: 1, timeout_s: 3, on_fail: vent}
  - move: {displacement_mm: 7, duration_s: 1, on_contact: fail, retries: 2, on_fail: continue, pressure_max_kpa: 30}
  - grip: {displacement_mm: 9, duration_s: 1, squeeze_kpa: 4, squeeze_speed_kpa_per_s: 6, settle_s: 0.1, verify: {by: detection, window_s: 0.4}, timeout_s: 4, on_fail: hold}
  - hold: {until: release, reverify_every_s: 0.5, squeeze_max_kpa: 3, on_fail: vent}
  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.1, cycles: 5, on_contact: grip}
  - pressure: {signal: sp2, on_contact: hold}
  - pressure: {signal: sp2}
)",
                             problems);
  ASSERT_TRUE(sequence) << problems.format();
  const auto& steps = sequence->steps;
  EXPECT_EQ(steps[0].on_contact, OnContact::hold)
      << "a move without a tolerance must hold the pressure at a contact";
  EXPECT_TRUE(std::isinf(steps[0].bounds.squeeze_max_kpa) && std::isinf(steps[0].bounds.pressure_max_kpa));
  EXPECT_EQ(steps[1].on_contact, OnContact::fail) << "a move with a tolerance must fail at a contact";
  EXPECT_EQ(steps[2].on_contact, OnContact::fail);
  EXPECT_EQ(steps[2].on_fail, OnFail::carry_on);
  EXPECT_EQ(steps[2].retries, 2U);
  EXPECT_EQ(steps[2].bounds.pressure_max_kpa, 30);
  EXPECT_EQ(steps[3].squeeze.by_kpa, 4);
  EXPECT_EQ(steps[3].squeeze.speed_kpa_per_s, 6);
  EXPECT_EQ(steps[3].bounds.squeeze_max_kpa, 4)
      << "without squeeze_max_kpa, squeeze_kpa is also the limit of the gripping pressure";
  EXPECT_TRUE(std::isinf(steps[4].hold_s));
  EXPECT_EQ(steps[4].bounds.squeeze_max_kpa, 3);
  EXPECT_EQ(steps[5].on_contact, OnContact::grip);
  EXPECT_EQ(steps[6].on_contact, OnContact::hold);
  EXPECT_EQ(steps[7].on_contact, OnContact::ignore)
      << "a pressure step without on_contact must ignore contacts";
}

TEST(SequenceFile, EveryKeyOfASequenceIsRead) {
  document::Problems problems;
  const auto sequence = read(R"(
name: all
about: one line
interlock: always
channels: [left]
steps:
  - move: {name: near, displacement_mm: 5, duration_s: 1, settle_s: 0.2, tolerance_mm: 0.5, timeout_s: 3, retries: 2, on_fail: continue}
  - grip: {pressure_kpa: 30, speed_kpa_per_s: 20, settle_s: 0.1, verify: {by: detection, window_s: 0.4, displacement_max_mm: 12}, timeout_s: 4, on_fail: hold}
  - hold: {hold_s: 2, reverify_every_s: 0.5, on_fail: vent}
  - release: {pressure_kpa: 3, duration_s: 0.5, purge_s: 0.7, timeout_s: 4, on_fail: abort}
  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: 0.1, cycles: 5}
  - pressure: {signal: sp2, scale: 0.5, cycles: 2}
  - pressure: {points: [{time_s: 0, pressure_kpa: 5}, {time_s: 2, pressure_kpa: 9}, {time_s: 3, pressure_kpa: 5}]}
)",
                             problems);
  ASSERT_TRUE(sequence) << problems.format();
  EXPECT_EQ(sequence->interlock, Interlock::always);
  EXPECT_EQ(sequence->channels, std::vector<std::string>{"left"});
  ASSERT_EQ(sequence->steps.size(), 7U);
  const Step& move = sequence->steps[0];
  EXPECT_EQ(move.name, "near");
  EXPECT_EQ(move.target.quantity, Target::Quantity::displacement_mm);
  EXPECT_EQ(move.target.value, 5);
  EXPECT_EQ(move.target.duration_s, 1);
  EXPECT_EQ(move.tolerance_mm, 0.5);
  EXPECT_EQ(move.retries, 2U);
  EXPECT_EQ(move.on_fail, OnFail::carry_on);
  const Step& grip = sequence->steps[1];
  EXPECT_EQ(grip.target.quantity, Target::Quantity::pressure_kpa);
  EXPECT_EQ(grip.target.speed, 20);
  EXPECT_EQ(grip.verify.window_s, 0.4);
  EXPECT_EQ(grip.verify.displacement_max_mm, 12);
  EXPECT_EQ(grip.verify.displacement_min_mm, -INFINITY);
  EXPECT_EQ(grip.on_fail, OnFail::hold);
  EXPECT_EQ(sequence->steps[2].reverify_every_s, 0.5);
  EXPECT_EQ(sequence->steps[3].target.value, 3);
  EXPECT_FALSE(sequence->steps[3].target.at_rest);
  EXPECT_EQ(sequence->steps[3].purge_s, 0.7);
  EXPECT_EQ(sequence->steps[4].sine.cycles, 5U);
  EXPECT_EQ(sequence->steps[5].profile.signal, model::SignalName::sp2);
  EXPECT_EQ(sequence->steps[5].profile.scale, 0.5);
  EXPECT_EQ(sequence->steps[5].profile.cycles, 2U);
  EXPECT_FALSE(sequence->steps[6].profile.signal);
  EXPECT_EQ(sequence->steps[6].profile.points, (std::vector<Point>{{0, 5}, {2, 9}, {3, 5}}));
}

/// Returns a sequence with one pressure step, which has `count` points at intervals of 1 s.
std::string with_points(int count) {
  std::string points;
  for (int i = 0; i < count; ++i) {
    points += (i > 0 ? ", " : "") + std::string("{time_s: ") + std::to_string(i) + ", pressure_kpa: 1}";
  }
  return with_step("pressure: {points: [" + points + "]}");
}

std::string with_steps(int count) {
  std::string text = "name: x\nsteps:\n";
  for (int i = 0; i < count; ++i) text += "  - move: {pressure_kpa: 5, duration_s: 1}\n";
  return text;
}

/// Returns a sequence with one grip step. `verify` is inserted into the step: it is empty, or it is the text
/// ", verify: {...}" with the leading comma.
std::string with_verify(const std::string& verify) {
  return with_step("grip: {pressure_kpa: 5, settle_s: 0" + verify + ", timeout_s: 9, on_fail: vent}");
}

TEST(SequenceFile, AnEmptyFileIsRefusedWithAReason) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/empty.yaml";
  for (const char* const text : {"", "# nothing\n", "\n---\n"}) {
    ASSERT_TRUE(write_file(path, text));
    document::Problems problems;
    EXPECT_FALSE(load_sequence(path, problems)) << text;
    EXPECT_NE(problems.format().find("found nothing"), std::string::npos) << problems.format();
  }
}

struct Broken {
  const char* what;
  std::string text;
  int line;             ///< line of the file in which the first problem must be reported
  std::string message;  ///< text that the message of one problem must contain
};

class BrokenSequence : public testing::TestWithParam<Broken> {};

TEST_P(BrokenSequence, IsRefusedWithLineAndReason) {
  document::Problems problems;
  EXPECT_FALSE(read(GetParam().text, problems));
  ASSERT_FALSE(problems.empty());
  const std::string all = problems.format();
  EXPECT_EQ(problems.list().front().at.line, GetParam().line) << all;
  EXPECT_NE(all.find(GetParam().message), std::string::npos) << all;
}

INSTANTIATE_TEST_SUITE_P(
    , BrokenSequence,
    testing::Values(
        Broken{"no_steps", "name: x\n", 1, "steps"},
        Broken{"empty_steps", "name: x\nsteps: []\n", 2, "at least one step"},
        Broken{"unknown_kind", with_step("grib: {}"), 3, "did you mean 'grip'?"},
        Broken{"two_kinds", "name: x\nsteps:\n  - move: {}\n    hold: {}\n", 3, "one key"},
        Broken{"step_is_text", with_step("move"), 3, "one key"},
        Broken{"unknown_key", with_step("hold: {hold_s: 1, reverify_every_s: 0.5, on_fail: vent, force: 3}"),
               3, "force"},
        Broken{"both_targets", with_step("move: {displacement_mm: 5, pressure_kpa: 5, duration_s: 1}"), 3,
               "not in both"},
        Broken{"no_target", with_step("move: {duration_s: 1}"), 3, "pressure_kpa"},
        Broken{"wrong_speed", with_step("move: {displacement_mm: 5, speed_kpa_per_s: 5}"), 3,
               "speed_mm_per_s"},
        Broken{
            "squeeze_without_speed",
            with_step(
                "grip: {displacement_mm: 5, speed_mm_per_s: 5, squeeze_kpa: 4, settle_s: 0.1, verify: {by: "
                "detection, window_s: 0.2}, timeout_s: 3, on_fail: vent}"),
            3, "squeeze_speed_kpa_per_s"},
        Broken{"speed_without_squeeze",
               with_step(
                   "grip: {displacement_mm: 5, speed_mm_per_s: 5, squeeze_speed_kpa_per_s: 4, settle_s: 0.1, "
                   "verify: {by: detection, window_s: 0.2}, timeout_s: 3, on_fail: vent}"),
               3, "requires squeeze_kpa"},
        Broken{
            "squeeze_above_its_bound",
            with_step(
                "grip: {displacement_mm: 5, speed_mm_per_s: 5, squeeze_kpa: 4, squeeze_speed_kpa_per_s: 4, "
                "squeeze_max_kpa: 3, settle_s: 0.1, verify: {by: detection, window_s: 0.2}, timeout_s: 3, "
                "on_fail: vent}"),
            3, "below squeeze_kpa"},
        Broken{"two_ends_of_a_hold",
               with_step("hold: {hold_s: 5, until: release, reverify_every_s: 0.2, on_fail: vent}"), 3,
               "not both"},
        Broken{"no_end_of_a_hold", with_step("hold: {reverify_every_s: 0.2, on_fail: vent}"), 3, "hold_s"},
        Broken{"contact_that_fails_somehow",
               with_step("move: {displacement_mm: 5, speed_mm_per_s: 5, on_contact: fail}"), 3, "on_fail"},
        Broken{
            "contact_of_a_grip",
            with_step(
                "grip: {displacement_mm: 5, speed_mm_per_s: 5, on_contact: hold, settle_s: 0.1, verify: {by: "
                "detection, window_s: 0.2}, timeout_s: 3, on_fail: vent}"),
            3, "on_contact"},
        Broken{"both_ramps", with_step("move: {displacement_mm: 5, speed_mm_per_s: 5, duration_s: 3}"), 3,
               "not both"},
        Broken{"jump", with_step("move: {displacement_mm: 5}"), 3, "requires speed_mm_per_s"},
        Broken{"not_finite", with_step("move: {displacement_mm: .nan, duration_s: 1}"), 3, "displacement_mm"},
        Broken{"far", with_step("move: {displacement_mm: 5000, duration_s: 1}"), 3, "displacement_mm"},
        Broken{
            "silent_failure",
            with_step(
                "grip: {pressure_kpa: 5, settle_s: 0, verify: {by: detection, window_s: 1}, timeout_s: 9}"),
            3, "on_fail"},
        Broken{"blind_position",
               with_step("grip: {pressure_kpa: 5, settle_s: 0, verify: {by: position, window_s: 1}, "
                         "timeout_s: 9, on_fail: vent}"),
               3, "displacement_min_mm and displacement_max_mm"},
        Broken{"mixed_verify",
               with_step("grip: {pressure_kpa: 5, settle_s: 0, verify: {by: pressure, window_s: 1, "
                         "pressure_min_kpa: 4, displacement_min_mm: 3}, timeout_s: 9, on_fail: vent}"),
               3, "displacement_min_mm"},
        Broken{"tolerance_of_pressure",
               with_step("move: {pressure_kpa: 5, tolerance_mm: 1, timeout_s: 3, on_fail: vent}"), 3,
               "requires a target"},
        Broken{"backwards",
               with_step("pressure: {points: [{time_s: 0, pressure_kpa: 1}, {time_s: 2, pressure_kpa: 1}, "
                         "{time_s: 1, pressure_kpa: 1}]}"),
               3, "must not be below time_s of the previous point"},
        Broken{"late_start",
               with_step("pressure: {points: [{time_s: 1, pressure_kpa: 1}, {time_s: 2, pressure_kpa: 1}]}"),
               3, "time_s: 0"},
        Broken{"no_closed_cycle",
               with_step("pressure: {points: [{time_s: 0, pressure_kpa: 1}, {time_s: 2, pressure_kpa: 2}], "
                         "cycles: 2}"),
               3, "the last point of a repeated profile"},
        Broken{"points_and_signal",
               with_step("pressure: {signal: tp1, points: [{time_s: 0, pressure_kpa: 1}, {time_s: 2, "
                         "pressure_kpa: 2}]}"),
               3, "not both"},
        Broken{"unknown_signal", with_step("pressure: {signal: tp3}"), 3, "tp1"},
        Broken{
            "twice",
            "name: x\nchannels: [a, a]\nsteps:\n  - hold: {hold_s: 1, reverify_every_s: 1, on_fail: vent}\n",
            2, "listed twice"},
        Broken{"misspelled_channels", "name: x\nchanels: [a]\nsteps:\n  - pressure: {signal: tp1}\n", 2,
               "did you mean `channels`?"},
        Broken{"misspelled_displacement", with_step("move: {displacment_mm: 5, duration_s: 1}"), 3,
               "did you mean `displacement_mm`?"},
        Broken{"scale_without_signal",
               with_step("pressure: {scale: 2, points: [{time_s: 0, pressure_kpa: 1}, {time_s: 2, "
                         "pressure_kpa: 1}]}"),
               3, "unknown key `scale`"},
        Broken{
            "pressure_of_a_point",
            with_step("pressure: {points: [{time_s: 0, pressure_kpa: 5}, {time_s: 2, pressure_kpa: 1001}]}"),
            3, "`pressure_kpa` is 1001, allowed is -100 to 1000"},
        Broken{"kind_like_no_other", with_step("xyzzyxyzzy: {}"), 3, "unknown kind of step 'xyzzyxyzzy'"},
        Broken{"step_that_is_a_list", with_step("[move]"), 3, "one key"},
        Broken{"too_many_steps", with_steps(201), 3, "more than 200 steps"},
        Broken{"interlock", "name: x\ninterlock: sometimes\nsteps:\n  - pressure: {signal: tp1}\n", 2,
               "always"},
        Broken{"no_channels", "name: x\nchannels: []\nsteps:\n  - pressure: {signal: tp1}\n", 2,
               "at least one channel"},
        Broken{"channel_that_is_a_map", "name: x\nchannels: [{a: 1}]\nsteps:\n  - pressure: {signal: tp1}\n",
               2, "the name of a channel"},
        Broken{"channel_without_a_name", "name: x\nchannels: [\"\"]\nsteps:\n  - pressure: {signal: tp1}\n",
               2, "the name of a channel"},
        Broken{"no_verify", with_verify(""), 3, "verify"},
        Broken{"half_a_position",
               with_verify(", verify: {by: position, window_s: 1, displacement_min_mm: 3}"), 3,
               "displacement_min_mm and displacement_max_mm"},
        Broken{"window_upside_down",
               with_verify(
                   ", verify: {by: position, window_s: 1, displacement_min_mm: 5, displacement_max_mm: 5}"),
               3, "must be above displacement_min_mm"},
        Broken{"no_profile", with_step("pressure: {cycles: 2}"), 3, "points"},
        Broken{"one_point", with_points(1), 3, "at least two points"},
        Broken{"too_many_points", with_points(5000), 3, "more than 20000 values"}),
    [](const auto& broken) { return broken.param.what; });

TEST(SequenceFile, ADocumentWithParseErrorsGivesNoSequence) {
  for (const char* text : {"name: x\nsteps:\n  - pressure: {signal: tp1}\n  - hold: [",
                           "name: &a x\nsteps:\n  - pressure: {signal: tp1}\n",
                           "name: x\nsteps:\n  - pressure: {signal: tp1, scale: !!float 1}\n"}) {
    document::Problems problems;
    EXPECT_FALSE(read(text, problems)) << text;
    EXPECT_FALSE(problems.empty());
  }
}

TEST(SequenceFile, Accepts3900PointsAnd200Steps) {
  document::Problems problems;
  EXPECT_TRUE(read(with_points(3900), problems)) << problems.format();
  EXPECT_TRUE(read(with_steps(200), problems)) << problems.format();
}

TEST(SequenceFile, ASpeedLeavesTheDurationAtZero) {
  document::Problems problems;
  const auto sequence = read(with_step("move: {displacement_mm: 5, speed_mm_per_s: 4}"), problems);
  ASSERT_TRUE(sequence) << problems.format();
  EXPECT_EQ(sequence->steps[0].target.speed, 4);
  EXPECT_EQ(sequence->steps[0].target.duration_s, 0);
}

TEST(SequenceFile, AMissingOrBrokenFileGivesNoSequence) {
  document::Problems problems;
  EXPECT_FALSE(load_sequence(SOFTGRIP_SOURCE_DIR "/config/sequences/missing.yaml", problems));
  EXPECT_NE(problems.format().find("missing.yaml"), std::string::npos) << problems.format();
  EXPECT_FALSE(load_sequence(SOFTGRIP_SOURCE_DIR "/tests/config/broken/bracket_open.yaml", problems));
}

TEST(SequenceFile, TheExampleOfTheManualIsAValidSequence) {
  const std::string manual = test::text_of(SOFTGRIP_SOURCE_DIR "/docs/reference/sequence-file.md");
  const std::size_t begin = manual.find("```yaml\n");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t text = begin + 8;
  document::Problems problems;
  const auto sequence = read(manual.substr(text, manual.find("```", text) - text), problems);
  ASSERT_TRUE(sequence) << problems.format();
  EXPECT_TRUE(prepare(*sequence, two_finger_settings(), problems)) << problems.format();
}

TEST(SequenceFile, AllErrorsAreReportedTogether) {
  document::Problems problems;
  EXPECT_FALSE(
      read("nam: x\nsteps:\n  - grib: {}\n  - move: {displacement_mm: 1}\n  - hold: {}\n", problems));
  std::vector<int> lines;
  for (const auto& problem : problems.list()) {
    lines.push_back(problem.at.line);
  }
  for (const int line : {1, 3, 4, 5}) {
    EXPECT_NE(std::find(lines.begin(), lines.end(), line), lines.end()) << line << "\n" << problems.format();
  }
}

}  // namespace
}  // namespace softgrip::control::sequence_file_test
