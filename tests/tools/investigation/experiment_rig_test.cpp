// Tests the exit code of a command that runs an experiment, for each way in which the daemon of the
// experiment can end.

#include "tools/investigation/experiment_rig.h"
#include "base/files.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <utility>

#include "document/problem.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "tools/baseline/commissioning_run.h"

namespace softgrip::tools::experiment_rig_test {
namespace {

using control::SequenceEnd;
using daemon::Ending;

/// Returns a rig for an experiment. Its daemon reports a fault and then ends with `outcome`.
ExperimentRig rig_that_ends(const daemon::Outcome& outcome) {
  document::Problems problems;
  rig::RigFile file = rig::load_rig(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", problems).value();
  ExperimentRig rig = experiment_rig(std::move(file), "left").value();
  rig.run = [outcome](const rig::RigFile&, const daemon::DaemonOptions& options) {
    daemon::EventEntry event;
    event.severity = daemon::Severity::error;
    event.text = "Fault F303";
    if (options.on_event) options.on_event(event);
    return outcome;
  };
  return rig;
}

daemon::Outcome outcome_of(Ending ending, std::optional<SequenceEnd> end, bool safe_state_confirmed) {
  daemon::Outcome outcome;
  outcome.ending = ending;
  outcome.sequence_end = end;
  outcome.safe_state_confirmed = safe_state_confirmed;
  return outcome;
}

NotPlayed refused(const daemon::Outcome& outcome) {
  const ScratchFolder folder;
  const ExperimentRig rig = rig_that_ends(outcome);
  const sysid::Waveform waveform = sysid::experiment_menu(rig.limits(0, 0)).front();
  const auto played = run_on(rig, "one", sysid::sequence_yaml(waveform, rig.channel_name()), folder.path());
  EXPECT_FALSE(played);
  return played ? NotPlayed{} : played.error();
}

TEST(ExperimentRig, EveryEndingHasAnExitCodeAndAFaultIsNamed) {
  const NotPlayed faulted = refused(outcome_of(Ending::sequence_ended, SequenceEnd::faulted, true));
  EXPECT_FALSE(faulted.stopped);
  EXPECT_EQ(faulted.code, ExitCode::not_acceptable);
  EXPECT_EQ(faulted.why, "the experiment did not run to its end: Fault F303");
  EXPECT_EQ(refused(outcome_of(Ending::sequence_ended, SequenceEnd::faulted, false)).code, ExitCode::failed)
      << "the safe outputs are not confirmed";
  EXPECT_EQ(refused(outcome_of(Ending::board_taken, std::nullopt, false)).code, ExitCode::io);
  EXPECT_EQ(refused(outcome_of(Ending::sequence_ended, SequenceEnd::done, false)).code, ExitCode::io)
      << "the board did not confirm the safe outputs";
  daemon::Outcome interrupted = outcome_of(Ending::interrupted, std::nullopt, true);
  interrupted.signal = SIGINT;
  EXPECT_TRUE(refused(interrupted).stopped);
  EXPECT_EQ(refused(interrupted).why, "stopped by the user; the rig is vented");
  interrupted.left_on = {{"left", 30}};
  EXPECT_EQ(
      refused(interrupted).why,
      "stopped by the user; left (30 kPa) remains under pressure, because the board has no watchdog that "
      "vents");
  interrupted.safe_state_confirmed = false;
  EXPECT_FALSE(refused(interrupted).stopped);
  EXPECT_EQ(refused(interrupted).code, ExitCode::failed);
}

TEST(ExperimentRig, ARigThatPermitsOnlyAVacuumIsRefused) {
  document::Problems problems;
  rig::RigFile file = rig::load_rig(SOFTGRIP_SOURCE_DIR "/config/vacuum/rig.yaml", problems).value();
  EXPECT_TRUE(experiment_rig(file, "left"));
  file.settings.channels[0].limits.pressure_max_kpa = 0;
  const auto rig = experiment_rig(file, "left");
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error(),
            "channel 'left' permits no pressure above 0 kPa (pressure_max_kpa: 0), but experiments raise the "
            "pressure");
}

bool agree(const std::string&) {
  return true;
}

sysid::NextExperiment ramp() {
  sysid::NextExperiment experiment;
  experiment.best.emplace().waveform.corners = {{0, 0}, {2, 20}, {4, 0}};
  return experiment;
}

TEST(ExperimentRig, ALogOfAnEarlierCallIsNoResultOfACommand) {
  const ScratchFolder folder;
  const std::string log = folder.path() + "/log.csv";
  const std::string write_log = "sed 's/pressure_command_kpa/&,displacement_mm/; 2,$s/,.*/&&/' <";
  ASSERT_TRUE(write_file(folder.path() + "/play.sh", write_log + "\"$1\" >\"$2\"\n"));
  const auto written = command_player("sh " + folder.path() + "/play.sh", 0.02, agree)(ramp(), folder.path());
  ASSERT_TRUE(written) << written.error().why;
  ASSERT_TRUE(is_there(log));
  const auto silent = command_player("true", 0.02, agree)(ramp(), folder.path());
  ASSERT_FALSE(silent);
  EXPECT_FALSE(silent.error().stopped);
  EXPECT_EQ(silent.error().code, ExitCode::failed);
  EXPECT_NE(silent.error().why.find("log.csv"), std::string::npos) << silent.error().why;
}

TEST(ExperimentRig, AGaugeFileOfAnEarlierCallIsNoResultOfACommand) {
  const ScratchFolder folder;
  ASSERT_TRUE(gauge_file_of({{0, 0, 1}, {5, 5, 1}, {10, 10, 1}}, folder.path()));
  const auto silent = command_gauge("true", agree)({0, 5, 10}, folder.path());
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, ExitCode::failed);
}

TEST(ExperimentRig, AnEarlierResultThatCannotBeRemovedIsAnError) {
  const ScratchFolder folder;
  ASSERT_TRUE(std::filesystem::create_directories(folder.path() + "/log.csv/inner"));
  const auto refused = command_player("true", 0.02, agree)(ramp(), folder.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().why.find("cannot remove the earlier result"), std::string::npos)
      << refused.error().why;
}

TEST(ExperimentRig, CommissioningReturnsTheExitCodeOfTheExperiment) {
  CommissioningOptions options;
  options.experiments = {"sharp_steps"};
  const auto runs = play_commissioning(
      rig_that_ends(outcome_of(Ending::sequence_ended, SequenceEnd::faulted, true)), options);
  ASSERT_FALSE(runs);
  EXPECT_EQ(runs.error().code, ExitCode::not_acceptable);
}

}  // namespace
}  // namespace softgrip::tools::experiment_rig_test
