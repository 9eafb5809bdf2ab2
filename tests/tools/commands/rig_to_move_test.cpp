#include "tools/commands/rig_to_move.h"

#include <gtest/gtest.h>

#include <regex>

#include "base/files.h"
#include "daemon/service/board_lock.h"

namespace softgrip::tools::rig_to_move_test {
namespace {

const std::string simulated = SOFTGRIP_SOURCE_DIR "/config/rig.yaml";
const std::string real = SOFTGRIP_SOURCE_DIR "/config/rig_tcp.yaml";

TEST(RigToMove, ASimulatedRigNeedsNoConsent) {
  const auto rig = rig_to_move(simulated, "right", false);
  ASSERT_TRUE(rig);
  EXPECT_TRUE(rig->simulated);
  EXPECT_EQ(rig->channel_name(), "right");
}

TEST(RigToMove, EveryRefusalHasASpecificExitCode) {
  EXPECT_EQ(rig_to_move("nowhere.yaml", "", true).error(), ExitCode::io);
  EXPECT_EQ(rig_to_move(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", "", true).error(),
            ExitCode::input_refused);
  EXPECT_EQ(rig_to_move(simulated, "", true).error(), ExitCode::usage)
      << "the rig has two channels, but no channel was selected";
  EXPECT_EQ(rig_to_move(simulated, "middle", true).error(), ExitCode::usage);
}

TEST(RigToMove, PrintsTheWarningsOfTheFile) {
  std::string text = read_file(simulated, 65536).value();
  text = std::regex_replace(text, std::regex("models/"), SOFTGRIP_SOURCE_DIR "/config/models/");
  text = std::regex_replace(text, std::regex("mode: \"0660\""), "mode: \"0666\"");
  const ScratchFolder folder;
  const std::string path = folder.path() + "/rig.yaml";
  ASSERT_TRUE(write_file(path, text));
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(rig_to_move(path, "left", true));
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("everyone on this machine may move the gripper"),
            std::string::npos);
}

TEST(RigToMove, RefusesABoardLockedByAnotherProgram) {
  document::Problems problems;
  const auto file = rig::load_rig(real, problems);
  ASSERT_TRUE(file);
  {
    const auto held = daemon::BoardLock::take(*file);
    ASSERT_TRUE(held) << held.error();
    EXPECT_EQ(rig_to_move(real, "left", true).error(), ExitCode::state_refused);
  }
  EXPECT_TRUE(rig_to_move(real, "left", true)) << "the lock of the board must be free";
  EXPECT_TRUE(daemon::BoardLock::take(*file));
}

TEST(RigToMove, TheYesOptionGivesConsentWithoutAQuestion) {
  EXPECT_TRUE(consent_on_terminal(true)("it will move"));
}

}  // namespace
}  // namespace softgrip::tools::rig_to_move_test
