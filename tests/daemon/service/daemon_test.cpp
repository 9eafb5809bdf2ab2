#include "daemon/service/daemon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/files.h"
#include "tests/daemon/rig_under_test.h"

namespace softgrip::daemon::daemon_test {
namespace {

TEST(Daemon, VirtualTimeRequiresAnEndOfTheRun) {
  DaemonOptions options;
  options.virtual_time = true;
  const auto daemon = Daemon::create(testing::example_rig("rig.yaml"), options);
  ASSERT_FALSE(daemon);
  EXPECT_NE(daemon.error().text.find("end"), std::string::npos);
}

TEST(Daemon, VirtualTimeNeedsASimulatedBoard) {
  DaemonOptions options;
  options.virtual_time = true;
  options.duration_s = 1;
  const auto daemon = Daemon::create(testing::example_rig("rig_tcp.yaml"), options);
  ASSERT_FALSE(daemon);
  EXPECT_NE(daemon.error().text.find("simulated"), std::string::npos);
}

TEST(Daemon, AFileInPlaceOfTheRecordingFolderIsRefusedBeforeTheRun) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder.path() + "/file", "mine"));
  DaemonOptions options;
  options.record_folder = folder.path() + "/file";
  const auto daemon = Daemon::create(testing::example_rig("rig.yaml"), options);
  ASSERT_FALSE(daemon);
  EXPECT_EQ(daemon.error().code, ExitCode::io);
  EXPECT_NE(daemon.error().text.find("Not a directory"), std::string::npos) << daemon.error().text;
}

TEST(Daemon, RunsASequenceAndReportsItsResult) {
  rig::RigFile rig = testing::example_rig("rig.yaml");
  rig.recorder.mode = rig::RecorderSettings::Mode::off;
  DaemonOptions options;
  options.virtual_time = true;
  options.sequence = testing::example_sequence(rig, "pick_stone.yaml");
  std::vector<std::string> kinds;
  options.on_event = [&kinds](const EventEntry& event) { kinds.push_back(event.kind); };
  const auto daemon = Daemon::create(std::move(rig), options);
  ASSERT_TRUE(daemon) << daemon.error().text;
  const Outcome outcome = (*daemon)->run();
  EXPECT_EQ(outcome.ending, Ending::sequence_ended);
  EXPECT_EQ(outcome.sequence_end, control::SequenceEnd::done);
  EXPECT_EQ(outcome.last.channels[0].result, control::GripResult::released);
  EXPECT_TRUE(outcome.safe_state_confirmed);
  EXPECT_EQ(exit_code_of(outcome), ExitCode::done);
  EXPECT_NE(std::find(kinds.begin(), kinds.end(), "sequence_finished"), kinds.end());
}

TEST(Daemon, ReportsRemainingPressureFor5KpaAndNotFor50Pa) {
  for (const auto& [kpa, on] : {std::pair{"0.05", false}, {"5", true}}) {
    rig::RigFile rig = testing::example_rig("rig.yaml");
    rig.recorder.mode = rig::RecorderSettings::Mode::off;
    rig.settings.safety.safe_action.fill(control::SafeAction::hold);
    DaemonOptions options;
    options.virtual_time = true;
    const auto loaded =
        SequenceLoader(rig.settings, "")
            .load_text("press.yaml", std::string("name: press\nsteps:\n  - move: {pressure_kpa: ") + kpa +
                                         ", duration_s: 0.5}\n");
    ASSERT_TRUE(loaded) << loaded.error().format();
    options.sequence = *loaded;
    const auto daemon = Daemon::create(std::move(rig), options);
    ASSERT_TRUE(daemon) << daemon.error().text;
    const Outcome outcome = (*daemon)->run();
    EXPECT_EQ(outcome.sequence_end, control::SequenceEnd::done);
    EXPECT_NEAR(outcome.last.channels[0].safe_kpa, std::stod(kpa), 1e-3);
    EXPECT_EQ(!outcome.left_on.empty(), on) << kpa;
    const std::string sentence = left_on_sentence(outcome);
    EXPECT_EQ(sentence.find("left (" + std::string(kpa) + " kPa)") != std::string::npos, on) << sentence;
    EXPECT_EQ(outcome.last.under_pressure != 0, on) << kpa;
  }
}

TEST(Daemon, AnExceptionInACallbackEndsWithSafeOutputs) {
  const ScratchFolder folder;
  rig::RigFile rig = testing::example_rig("rig.yaml");
  rig.recorder.mode = rig::RecorderSettings::Mode::off;
  rig.real_time = {};
  rig.real_time.lock_memory = false;  // the daemon runs in the process of the test, whose memory must not be
                                      // locked
  DaemonOptions options;
  options.listen = false;
  options.duration_s = 20;
  options.on_event = [](const EventEntry& event) {
    if (event.kind == "state_changed") throw std::runtime_error("on purpose");
  };
  const auto daemon = Daemon::create(std::move(rig), options);
  ASSERT_TRUE(daemon);
  const Outcome outcome = (*daemon)->run();
  EXPECT_EQ(outcome.ending, Ending::broken);
  EXPECT_EQ(outcome.message, "on purpose");
  EXPECT_TRUE(outcome.safe_state_confirmed);
  EXPECT_EQ(exit_code_of(outcome), ExitCode::failed);
  EXPECT_LT(outcome.wall_s, 10);
}

TEST(Daemon, EveryEndingHasItsExitCode) {
  Outcome outcome;
  outcome.safe_state_confirmed = true;
  const auto code = [&outcome](Ending ending) {
    outcome.ending = ending;
    return exit_code_of(outcome);
  };
  EXPECT_EQ(code(Ending::asked), ExitCode::done);
  EXPECT_EQ(code(Ending::interrupted), ExitCode::not_acceptable)
      << "the daemon was interrupted before the requested sequence finished";
  EXPECT_EQ(code(Ending::sequence_refused), ExitCode::state_refused);
  EXPECT_EQ(code(Ending::not_idle), ExitCode::state_refused);
  EXPECT_EQ(code(Ending::board_unreachable), ExitCode::io);
  EXPECT_EQ(code(Ending::real_time_refused), ExitCode::failed);
  EXPECT_EQ(code(Ending::socket_failed), ExitCode::io);
  EXPECT_EQ(code(Ending::board_taken), ExitCode::io);
  EXPECT_EQ(code(Ending::broken), ExitCode::failed);
  using control::SequenceEnd;
  for (const auto& [end, expected] : {std::pair{SequenceEnd::done, ExitCode::done},
                                      std::pair{SequenceEnd::failed, ExitCode::not_acceptable},
                                      std::pair{SequenceEnd::stopped, ExitCode::not_acceptable},
                                      std::pair{SequenceEnd::faulted, ExitCode::not_acceptable}}) {
    outcome.sequence_end = end;
    EXPECT_EQ(code(Ending::sequence_ended), expected);
  }
  outcome.safe_state_confirmed = false;
  outcome.sequence_end = SequenceEnd::done;
  EXPECT_EQ(code(Ending::sequence_ended), ExitCode::failed)
      << "if the safe outputs are not confirmed, the exit code is a failure";
  EXPECT_EQ(code(Ending::asked), ExitCode::failed);
  EXPECT_EQ(code(Ending::interrupted), ExitCode::failed);
}

}  // namespace
}  // namespace softgrip::daemon::daemon_test
