#include "sysid/health/recorded_health.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/sha256.h"
#include "model/file/model_file.h"
#include "sysid/health/health_page.h"
#include "sysid/health/health_result.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::health::recorded_health_test {
namespace {

class Recorded : public ::testing::Test {
 protected:
  Recorded() { write_baseline("baseline", 20); }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }
  [[nodiscard]] static std::string rows(const std::string& finger, double largest_kpa) {
    std::string csv = "time_s,channel,pressure_command_kpa,displacement_mm\n";
    for (int i = 0; i < 200; ++i) {
      const double share = 0.005 * i;
      csv += std::to_string(0.01 * i) + "," + finger + "," + std::to_string(share * largest_kpa) + "," +
             std::to_string(10 * share) + "\n";
    }
    return csv;
  }
  void write(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(write_file(at(name), text));
  }
  void write_baseline(const std::string& name, double largest_kpa) const {
    const std::string log = rows("left", largest_kpa);
    const std::string model = model::to_yaml(loaded("bench_twin"));
    write(name + "/healthy_1.csv", log);
    write(name + "/model.yaml", model);
    const nlohmann::ordered_json about{{"logs", {{{"file", "healthy_1.csv"}, {"sha256", sha256(log)}}}},
                                       {"model", {{"file", "model.yaml"}, {"sha256", sha256(model)}}}};
    write(name + "/baseline.json", about.dump());
  }
  [[nodiscard]] HealthQuestion question() const {
    HealthQuestion asked;
    asked.recordings = {at("recordings")};
    asked.baseline = at("baseline");
    return asked;
  }

  const ScratchFolder scratch;
  std::filesystem::path folder = scratch.path();
};

TEST_F(Recorded, FingerUsesAnOwnBaselineOrTheRigBaseline) {
  write("recordings/one/run.csv", rows("left", 20));
  write("recordings/two/run.csv", rows("right", 20));
  write_baseline("baseline/right", 25);
  const auto found = recorded_health(question());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->fingers.size(), 2U);
  EXPECT_EQ(found->fingers[0].source.baseline, at("baseline"));
  EXPECT_NEAR(found->fingers[0].source.base.full_kpa, 19.9, 1e-9);
  EXPECT_EQ(found->fingers[1].source.baseline, at("baseline/right"));
  EXPECT_NEAR(found->fingers[1].source.base.full_kpa, 24.875, 1e-9);
  EXPECT_FALSE(found->alarm());
  const auto json = result::json_of(fields_of(*found, 1'000'000'000));
  EXPECT_EQ(json["made_unix_s"], 1);
  EXPECT_EQ(json["fingers"][1]["finger"], "right");
}

TEST_F(Recorded, ExistingScoresAreKeptWithoutReadingRecordings) {
  write("recordings/one/run.csv", rows("left", 20));
  write("recordings/one/run.json", R"({"started_at": "2026-11-30T07:00:00Z", "state": "complete"})");
  const auto first = recorded_health(question());
  ASSERT_TRUE(first);
  write("recordings/one/run.csv", "");
  write("recordings/two/run.csv", rows("left", 20));
  HealthQuestion again = question();
  again.scores = first->scores.substr(0, first->scores.size() - 1);
  const auto second = recorded_health(again);
  ASSERT_TRUE(second);
  EXPECT_TRUE(second->skipped.empty());
  EXPECT_EQ(second->scores.rfind(first->scores, 0), 0U);
  EXPECT_EQ(read_scores(second->scores).size(), 2U);
}

TEST_F(Recorded, AFingerWithoutABaselineIsReportedOnceInEachCall) {
  for (const char* name : {"one", "two", "three"}) {
    const std::string right = rows("right", 20);
    write(std::string("recordings/") + name + "/run.csv",
          rows("left", 20) + right.substr(right.find('\n') + 1));
  }
  write_baseline("rig/left", 20);
  HealthQuestion asked = question();
  asked.baseline = at("rig");
  for (int call = 0; call < 2; ++call) {
    const auto found = recorded_health(asked);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->fingers.size(), 1U);
    ASSERT_EQ(found->skipped.size(), 1U) << "call " << call;
    EXPECT_EQ(found->skipped[0].finger, "right");
    EXPECT_NE(found->skipped[0].why.find("no baseline of `right`"), std::string::npos);
    EXPECT_NE(found->skipped[0].why.find("in 3 recordings"), std::string::npos) << found->skipped[0].why;
    EXPECT_EQ(result::json_of(fields_of(*found, 1))["skipped"][0]["finger"], "right");
    EXPECT_EQ(read_scores(found->scores).size(), 6U) << "no recording is read a second time";
    asked.scores = found->scores;
  }
  write_baseline("rig/right", 20);
  const auto complete = recorded_health(asked);
  ASSERT_TRUE(complete);
  EXPECT_EQ(complete->fingers.size(), 2U) << "the recordings are read again for the new baseline";
  EXPECT_TRUE(complete->skipped.empty());
}

TEST_F(Recorded, AMissingBaselineIsAnError) {
  write("recordings/one/run.csv", rows("left", 20));
  HealthQuestion asked = question();
  asked.baseline = at("nothing");
  const auto missing = recorded_health(asked);
  ASSERT_FALSE(missing);
  ASSERT_EQ(missing.error().baselines.size(), 1U);
  EXPECT_EQ(missing.error().baselines[0].why, at("nothing") + " does not exist");
  EXPECT_TRUE(missing.error().baselines[0].unreadable);
  asked.baseline = at("recordings");
  const auto other = recorded_health(asked);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().baselines[0].why.find("is not a baseline"), std::string::npos);
  EXPECT_FALSE(other.error().baselines[0].unreadable);
}

TEST_F(Recorded, AnEmptyFolderIsReported) {
  write("recordings/health/health.json", "{}");
  const auto found = recorded_health(question());
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->fingers.empty());
  ASSERT_EQ(found->skipped.size(), 1U);
  EXPECT_EQ(found->skipped[0].why, "the folder contains no recordings");
  EXPECT_FALSE(found->incomplete());
}

TEST_F(Recorded, APathThatCannotBeReadMakesTheResultIncomplete) {
  write("recordings/one/run.csv", rows("left", 20));
  const auto complete = recorded_health(question());
  ASSERT_TRUE(complete);
  EXPECT_FALSE(complete->incomplete());
  for (const std::string missing : {"missing", "baseline/model.yaml/run"}) {
    HealthQuestion asked = question();
    asked.recordings.push_back(at(missing));
    const auto found = recorded_health(asked);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->fingers.size(), 1U) << "the other paths are used";
    EXPECT_TRUE(found->incomplete());
    ASSERT_EQ(found->skipped.size(), 1U);
    EXPECT_EQ(found->skipped[0].run, at(missing));
    EXPECT_EQ(found->skipped[0].why.rfind("the path cannot be read: ", 0), 0U) << found->skipped[0].why;
  }
}

TEST_F(Recorded, ALogThatNamesNoFingerIsScored) {
  std::string log = rows("", 20);
  log.replace(log.find("channel,"), 8, "");
  for (std::size_t at = log.find(",,"); at != std::string::npos; at = log.find(",,")) log.erase(at, 1);
  write("log.csv", log);
  HealthQuestion asked = question();
  asked.recordings = {at("log.csv")};
  const auto found = recorded_health(asked);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->skipped.empty()) << found->skipped[0].why;
  ASSERT_EQ(found->fingers.size(), 1U);
  EXPECT_EQ(found->fingers[0].health.finger, "");
  EXPECT_EQ(health_sentence(found->fingers[0].health, found->fingers[0].suspicion),
            "There are too few grips to determine the reference values of the finger.");
  EXPECT_EQ(read_scores(found->scores).size(), 1U);
}

TEST_F(Recorded, ANoteAboutAnUnknownFingerIsRefused) {
  write("recordings/one/run.csv", rows("left", 20));
  write_baseline("baseline/thumb", 20);
  const auto with_note = [&](const std::string& finger) {
    HealthQuestion asked = question();
    document::Problems problems;
    asked.notes = *read_notes(
        "notes.yaml", "notes:\n  - {date: 2026-11-03, finger: " + finger + ", action: x}\n", problems);
    return recorded_health(asked);
  };
  EXPECT_TRUE(with_note("left")) << "a finger of a recording";
  EXPECT_TRUE(with_note("thumb")) << "a finger with a baseline";
  const auto misspelled = with_note("lft");
  ASSERT_FALSE(misspelled);
  ASSERT_EQ(misspelled.error().notes.list().size(), 1U);
  const document::Problem& problem = misspelled.error().notes.list()[0];
  EXPECT_EQ(problem.at.line, 2);
  EXPECT_NE(problem.message.find("`lft`"), std::string::npos);
  EXPECT_EQ(problem.hint, "did you mean `left`?");
}

TEST_F(Recorded, ARefusedBaselineIsAnError) {
  write("recordings/one/run.csv", rows("left", 20));
  write("baseline/model.yaml", "changed");
  const auto changed = recorded_health(question());
  ASSERT_FALSE(changed);
  ASSERT_EQ(changed.error().baselines.size(), 1U);
  EXPECT_NE(changed.error().baselines[0].why.find("model.yaml"), std::string::npos);
  write_baseline("baseline", 0);
  const auto without_pressure = recorded_health(question());
  ASSERT_FALSE(without_pressure);
  EXPECT_FALSE(without_pressure.error().baselines[0].why.empty() &&
               without_pressure.error().baselines[0].problems.empty());
}

}  // namespace
}  // namespace softgrip::sysid::health::recorded_health_test
