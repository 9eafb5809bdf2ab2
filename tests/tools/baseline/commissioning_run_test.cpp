#include "tools/baseline/commissioning_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "document/problem.h"
#include "model/catalogue.h"

namespace softgrip::tools::commissioning_run_test {
namespace {

/// Returns the rig of config/rig.yaml, but without the object between the fingers.
ExperimentRig free_rig() {
  document::Problems problems;
  rig::RigFile file = rig::load_rig(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", problems).value();
  for (auto& channel : std::get<simulation::SimulatedBoardSettings>(file.board).channels)
    channel.plant.object.reset();
  return experiment_rig(std::move(file), "left").value();
}

CommissioningOptions short_one() {
  CommissioningOptions options;
  options.experiments = {"sharp_steps"};
  return options;
}

TEST(CommissioningRun, RunsEachExperimentTwiceWithDifferentNoise) {
  std::vector<std::string> told;
  CommissioningOptions options = short_one();
  options.tell = [&](const std::string& line) { told.push_back(line); };
  const auto runs = play_commissioning(free_rig(), options);
  ASSERT_TRUE(runs) << runs.error().why;
  ASSERT_EQ(runs->first.size(), 1U);
  ASSERT_EQ(runs->second.size(), 1U);
  EXPECT_EQ(runs->first[0].name, "sharp_steps");
  EXPECT_EQ(runs->first[0].channel, "left");
  EXPECT_EQ(runs->first[0].pressure_command_kpa, runs->second[0].pressure_command_kpa);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < runs->first[0].size(); ++i)
    equal += runs->first[0].displacement_mm[i] == runs->second[0].displacement_mm[i] ? 1U : 0U;
  EXPECT_LT(equal, runs->first[0].size() / 10);
  ASSERT_EQ(told.size(), 4U);
  EXPECT_EQ(told[0].rfind("first: gentle_motion", 0), 0U) << told[0];
  EXPECT_EQ(told[1].rfind("first: first_load", 0), 0U) << told[1];
}

TEST(CommissioningRun, DoesNotMoveARealRigWithoutTheConsentOfTheOperator) {
  ExperimentRig rig = free_rig();
  rig.simulated = false;
  CommissioningOptions options = short_one();
  std::string question;
  options.consent = [&](const std::string& what) {
    question = what;
    return false;
  };
  options.tell = [](const std::string& line) { ADD_FAILURE() << line; };
  const auto runs = play_commissioning(rig, options);
  ASSERT_FALSE(runs);
  EXPECT_EQ(runs.error().code, ExitCode::failed);
  EXPECT_EQ(question.rfind("channel 'left' of simulated will move", 0), 0U) << question;
  EXPECT_NE(question.find("about 3.8 minutes"), std::string::npos) << question;
}

TEST(CommissioningRun, KeepsAFingerThatIsSofterThanTheModelWithinTheLimits) {
  for (const double share : {1.0, 0.6}) {
    ExperimentRig rig = free_rig();
    model::Model& believed = rig.rig.settings.channels[rig.channel].model;
    for (model::BlockSpec& block : believed.blocks) {
      if (std::string_view(model::catalogue()[block.type].info.id) != "bouc_wen") continue;
      block.values[0] *= share;  // the values 0 and 1 are alpha and beta, which determine the immediate
                                 // response of the finger
      block.values[1] *= share;
    }
    rig.rig.settings.channels[rig.channel].limits.displacement_max_mm = 15;
    const auto runs = play_commissioning(rig, short_one());
    ASSERT_TRUE(runs) << runs.error().why;
    const auto& readings = runs->first[0].displacement_mm;
    double furthest_mm = 0;
    for (const double reading : readings) furthest_mm = std::max(furthest_mm, reading);
    EXPECT_LT(furthest_mm, 15) << share;
    EXPECT_GT(furthest_mm, 9) << share;
  }
}

/// Adds a threshold to a model: the finger moves only above this pressure.
void add_threshold(model::Model& model, double threshold_kpa) {
  const auto id_of = [](std::size_t type) { return std::string_view(model::catalogue()[type].info.id); };
  std::size_t type = 0;
  while (id_of(type) != "actuator_threshold") ++type;
  const auto actuator = std::find_if(model.blocks.begin(), model.blocks.end(),
                                     [&](const auto& block) { return id_of(block.type) == "bouc_wen"; });
  model.blocks.insert(actuator, {type, {threshold_kpa}});
}

/// Returns the rig of config/rig.yaml, with a model that moves only above a threshold of the pressure.
ExperimentRig rig_with_threshold(double threshold_kpa) {
  ExperimentRig rig = free_rig();
  add_threshold(rig.rig.settings.channels[rig.channel].model, threshold_kpa);
  return rig;
}

/// The finger never moves, and its readings contain noise. The pressure follows the command.
TEST(CommissioningRun, RefusesAFingerThatDoesNotMoveAboveTheThresholdOfItsModel) {
  ExperimentRig rig = rig_with_threshold(20);
  auto& plants = std::get<simulation::SimulatedBoardSettings>(rig.rig.board).channels;
  for (auto& channel : plants) add_threshold(channel.plant.model, 1000);
  CommissioningOptions options = short_one();
  std::string told;
  options.tell = [&](const std::string& line) { told = line; };
  const auto runs = play_commissioning(rig, options);
  ASSERT_FALSE(runs);
  EXPECT_EQ(runs.error().code, ExitCode::not_acceptable);
  EXPECT_NE(runs.error().why.find("the finger hardly moved"), std::string::npos) << runs.error().why;
  EXPECT_EQ(told, "first: gentle_motion, up to 30 kPa, 10 s");
}

TEST(CommissioningRun, RefusesAModelThatPredictsNoMotion) {
  ExperimentRig rig = rig_with_threshold(70);
  rig.simulated = false;
  CommissioningOptions options = short_one();
  options.consent = [](const std::string& what) {
    ADD_FAILURE() << what;
    return false;
  };
  const auto runs = play_commissioning(rig, options);
  ASSERT_FALSE(runs);
  EXPECT_EQ(runs.error().code, ExitCode::not_acceptable);
  EXPECT_NE(runs.error().why.find("predicts a motion of 0 mm at 60 kPa"), std::string::npos)
      << runs.error().why;
}

TEST(CommissioningRun, TheExperimentMenuContainsEveryDefaultExperiment) {
  const auto menu = sysid::experiment_menu({});
  for (const std::string& name : usual_commissioning()) {
    EXPECT_TRUE(std::any_of(menu.begin(), menu.end(), [&](const auto& w) { return w.name == name; })) << name;
  }
}

}  // namespace
}  // namespace softgrip::tools::commissioning_run_test
