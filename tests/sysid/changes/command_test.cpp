// Runs `softgrip baseline` and `softgrip diagnose` with the arguments that a user would give.

#include <filesystem>
#include <tuple>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/sysid/changes/finger.h"
#include "tests/sysid/command_fixture.h"

namespace softgrip::sysid::command_test {
namespace {

using Json = nlohmann::json;
const std::string model = "'" SOFTGRIP_SOURCE_DIR "/tests/blind/textbook/given.yaml'";

class ChangeCommand : public CommandInFolder {
 protected:
  void SetUp() override {
    CommandInFolder::SetUp();
    write("h1.csv", format_log(test::log_of({}, 1)));
    write("h2.csv", format_log(test::log_of({}, 2)));
    write("later1.csv", format_log(test::log_of({.gain = 0.19}, 5)));
    write("later2.csv", format_log(test::log_of({.gain = 0.19}, 6)));
  }
};

TEST_F(ChangeCommand, DiagnoseFindsAgeingAgainstASavedBaseline) {
  ASSERT_EQ(run("baseline --data h1.csv h2.csv --model " + model + " --out base"), 0) << read("err.txt");
  EXPECT_EQ(read("base/healthy_2.csv"), read("h2.csv"));
  EXPECT_TRUE(Json::parse(read("base/baseline.json"))["check"].is_null());
  ASSERT_EQ(run("diagnose --baseline base --data later1.csv later2.csv --out out"), 0) << read("err.txt");
  const Json json = Json::parse(read("out/diagnosis.json"));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["question"], "change");
  ASSERT_FALSE(json["causes"].empty()) << json.dump(1);
  EXPECT_EQ(json["causes"][0]["id"], "ageing");
  EXPECT_NEAR(json["causes"][0]["size"]["value"].get<double>(), -5, 0.6);
  EXPECT_EQ(json["causes"][0]["next_steps"].size(), 2U);
  EXPECT_EQ(json["made_of"]["healthy"].size(), 2U);
}

TEST_F(ChangeCommand, AReportOfAChangeCanBeVerified) {
  // Every command below repeats the diagnosis. Half of the usual length is sufficient to compare the results.
  for (const auto& [name, finger, seed] : {std::tuple{"h1.csv", test::Finger{}, 1U},
                                           {"h2.csv", test::Finger{}, 2U},
                                           {"later1.csv", test::Finger{.gain = 0.19}, 5U}})
    write(name, format_log(test::log_of(finger, seed, false, 1000)));
  ASSERT_EQ(run("baseline --data h1.csv --model " + model + " --out base"), 0) << read("err.txt");
  ASSERT_EQ(run("diagnose --baseline base --data later1.csv --out out"), 0) << read("err.txt");
  EXPECT_EQ(run("report --verify out"), 0) << read("err.txt");
  ASSERT_EQ(run("diagnose --model " + model + " --healthy h1.csv --data later1.csv --out pair"), 0);
  EXPECT_EQ(run("report --verify pair"), 0) << read("err.txt");
  write("h1.csv", read("h2.csv"));
  EXPECT_EQ(run("report --verify pair"), 3);
  EXPECT_NE(read("err.txt").find("log h1.csv, sha256"), std::string::npos) << read("err.txt");
  std::filesystem::rename(folder_ / "base", folder_ / "moved");
  EXPECT_EQ(run("report --verify out"), 3);
  EXPECT_NE(read("err.txt").find("baseline base"), std::string::npos) << read("err.txt");
}

TEST_F(ChangeCommand, ALogThatIsComparedWithItselfIsReported) {
  ASSERT_EQ(run("diagnose --model " + model + " --healthy h1.csv --data h1.csv --out out"), 0);
  const std::string sentence = "h1: the log contains the same samples as the healthy log h1";
  EXPECT_NE(read("out.txt").find("warning: " + sentence), std::string::npos) << read("out.txt");
  EXPECT_NE(read("out/diagnosis.json").find(sentence), std::string::npos);
}

TEST_F(ChangeCommand, BaselineWithADifferentSecondRunExitsWith6) {
  EXPECT_EQ(run("baseline --data h1.csv h2.csv --check later1.csv --model " + model + " --out base"), 6);
  EXPECT_NE(Json::parse(read("base/baseline.json"))["check"]["verdict"], "unchanged");
}

TEST_F(ChangeCommand, CheckRepeatsTheResultOfASavedBaseline) {
  write("gauge.csv", "gauge_mm,displacement_mm\n0,0\n5,5\n10,10\n");
  write("again.csv", format_log(test::log_of({}, 3)));
  ASSERT_EQ(run("baseline --data h1.csv h2.csv --check again.csv --gauge gauge.csv --model " + model +
                " --out base --json"),
            0)
      << read("err.txt");
  const Json made = Json::parse(read("out.txt"));
  EXPECT_EQ(made["gauge"]["source"], "gauge.csv");
  EXPECT_GT(made["check"]["model_rmse_mm"]["second_run"].get<double>(), 0);
  ASSERT_EQ(run("baseline --check base --json"), 0) << read("err.txt");
  EXPECT_EQ(Json::parse(read("out.txt"))["check"], made["check"]);
  write("base/gauge.csv", "gauge_mm,displacement_mm\n0,1\n");
  EXPECT_EQ(run("baseline --check base"), 3);
  ASSERT_EQ(run("baseline --data h1.csv --check later1.csv --model " + model + " --out drifted"), 6);
  EXPECT_EQ(run("baseline --check drifted"), 6);
  ASSERT_EQ(run("baseline --data h1.csv --model " + model + " --out once"), 0);
  EXPECT_EQ(run("baseline --check once"), 3) << "the baseline has no second run";
}

TEST_F(ChangeCommand, ModifiedOrMissingBaselineIsRejected) {
  ASSERT_EQ(run("baseline --data h1.csv --model " + model + " --out base"), 0);
  write("base/healthy_1.csv", read("h2.csv"));
  EXPECT_EQ(run("diagnose --baseline base --data later1.csv --out out"), 3);
  EXPECT_NE(read("err.txt").find("healthy_1.csv"), std::string::npos) << read("err.txt");
  EXPECT_EQ(run("diagnose --baseline nowhere --data later1.csv --out out"), 4);
  EXPECT_EQ(run("diagnose --data later1.csv --out out"), 2);
}

}  // namespace
}  // namespace softgrip::sysid::command_test
