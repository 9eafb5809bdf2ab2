#include "sysid/health/scored_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::health::scored_run_test {
namespace {

ScoredRun example(const std::string& run, const std::string& finger, const std::string& baseline) {
  ScoredRun scored{run, finger, "2026-11-22T01:02:03Z", "pick 12345678 hold_s=5", baseline, {}};
  scored.score[sysid::HealthNumber::gain] = 31.25;
  return scored;
}

TEST(ScoredRun, LineIsReadBackWithAbsentValuesAsNan) {
  const std::string line = line_of(example("run-1", "left", "1-abc"));
  EXPECT_EQ(line.back(), '\n');
  const auto read = read_scores(line);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].run, "run-1");
  EXPECT_EQ(read[0].finger, "left");
  EXPECT_EQ(read[0].started_at, "2026-11-22T01:02:03Z");
  EXPECT_EQ(read[0].recipe, "pick 12345678 hold_s=5");
  EXPECT_EQ(read[0].baseline, "1-abc");
  EXPECT_EQ(read[0].score[sysid::HealthNumber::gain], 31.25);
  EXPECT_TRUE(std::isnan(read[0].score[sysid::HealthNumber::zero]));
}

TEST(ScoredRun, TemperatureIsOptionalInALine) {
  ScoredRun warm = example("run-1", "left", "1-abc");
  EXPECT_EQ(line_of(warm).find("temperature_c"), std::string::npos);
  EXPECT_TRUE(std::isnan(read_scores(line_of(warm))[0].temperature_c));
  warm.temperature_c = 23.5;
  EXPECT_EQ(read_scores(line_of(warm))[0].temperature_c, 23.5);
}

TEST(ScoredRun, TruncatedLineDoesNotAffectOtherLines) {
  const std::string first = line_of(example("run-1", "left", "a"));
  const std::string second = line_of(example("run-2", "left", "a"));
  for (std::size_t cut = 0; cut + 1 < first.size(); ++cut) {
    const auto read = read_scores(first.substr(0, cut) + "\n" + second);
    ASSERT_EQ(read.size(), 1U) << cut;
    EXPECT_EQ(read[0].run, "run-2");
  }
  EXPECT_TRUE(read_scores("").empty());
  EXPECT_TRUE(read_scores("null\n[]\n3\n").empty());
}

class FoundRuns : public ::testing::Test {
 protected:
  /// Writes a recording whose run.json contains this text. Without a text, writes no run.json. Returns the
  /// folder of the recording.
  [[nodiscard]] std::string run(const std::string& name, const std::string& story) const {
    const std::filesystem::path path = folder / name;
    std::string csv = "time_s,channel,pressure_command_kpa,displacement_mm\n";
    for (int i = 0; i < 200; ++i)
      csv += std::to_string(0.01 * i) + ",left," + std::to_string(0.1 * i) + ",0.1\n";
    EXPECT_TRUE(write_file((path / "run.csv").string(), csv));
    if (!story.empty()) {
      EXPECT_TRUE(write_file((path / "run.json").string(), story));
    }
    return path.string();
  }
  [[nodiscard]] RunScores scores() const {
    const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
    return score_runs(find_runs({folder.string()}), [&](const std::string&) { return &base; }, {});
  }

  const ScratchFolder scratch;
  std::filesystem::path folder = scratch.path();
};

TEST_F(FoundRuns, AreTheRecordingsOfAFolderSortedByName) {
  (void)run("b", "");
  (void)run("a", "");
  ASSERT_TRUE(write_file((folder / "health/health.json").string(), "{}"));
  const auto found = find_runs({folder.string(), (folder / "b").string()});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0], (folder / "a").string());
  EXPECT_EQ(found[1], (folder / "b").string());
  EXPECT_EQ(found[2], (folder / "b").string());
}

TEST_F(FoundRuns, HaveTheMedianRecordedTemperature) {
  const std::string path = run("a", "");
  std::string csv = "time_s,channel,pressure_command_kpa,displacement_mm,temperature_c\n";
  for (int i = 0; i < 200; ++i) {
    csv += std::to_string(0.01 * i) + ",left," + std::to_string(0.1 * i) + ",0.1,";
    csv += (i % 2 == 0 ? std::to_string(21.5 + 0.001 * (i - 100)) : "") + "\n";
  }
  ASSERT_TRUE(write_file(path + "/run.csv", csv));
  const RunScores found = scores();
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_NEAR(found.runs[0].temperature_c, 21.5, 0.01);
}

TEST_F(FoundRuns, UnfinishedAndNonSequenceRunsAreSkipped) {
  const std::string of_sequence =
      R"("software_version": "1", "sequence": {"name": "pick", "sha256": "0123456789"})";
  (void)run("1-good", "{" + of_sequence + R"(, "state": "complete"})");
  (void)run("2-running", "{" + of_sequence + R"(, "state": "recording"})");
  (void)run("3-fault", R"({"software_version": "1", "sequence": null, "state": "complete"})");
  const RunScores found = scores();
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(found.runs[0].run, "1-good");
  EXPECT_EQ(found.runs[0].recipe, "pick 01234567");
  ASSERT_EQ(found.skipped.size(), 2U);
  EXPECT_EQ(found.skipped[0].why, "the recording is not finished");
  EXPECT_NE(found.skipped[1].why.find("not belong to a single sequence"), std::string::npos);
}

TEST_F(FoundRuns, ARecordingThatBeginsDuringItsSequenceIsSkipped) {
  const std::string of_sequence =
      R"({"software_version": "1", "state": "complete", "sequence": {"name": "pick", "sha256": "0123456789"}, )";
  const auto events = [](const std::string& kind) {
    return R"("events": [{"time_s": 0.1, "kind": ")" + kind + R"(", "text": ""}]})";
  };
  (void)run("1-whole", of_sequence + events("sequence_started"));
  (void)run("2-half", of_sequence + events("step_started"));
  const RunScores found = scores();
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(found.runs[0].run, "1-whole");
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped[0].why, "the recording begins after the start of its sequence");
}

TEST_F(FoundRuns, TheLogOfARecordingWithoutSequenceIsNotRead) {
  for (const std::string state : {"complete", "recording"}) {
    const std::string path =
        run(state, R"({"software_version": "1", "sequence": null, "state": ")" + state + R"("})");
    ASSERT_TRUE(write_file(path + "/run.csv", "invalid\n"));
  }
  const RunScores found = scores();
  ASSERT_EQ(found.skipped.size(), 2U);
  EXPECT_NE(found.skipped[0].why.find("not belong to a single sequence"), std::string::npos)
      << found.skipped[0].why;
  EXPECT_EQ(found.skipped[1].why, "the recording is not finished");
}

TEST_F(FoundRuns, ASecondRecordingWithTheSameNameIsSkippedWithAReason) {
  (void)run("one/grip", "");
  (void)run("two/grip", "");
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const std::string one = (folder / "one").string(), two = (folder / "two").string();
  const RunScores found =
      score_runs(find_runs({one, two, one + "/grip"}), [&](const std::string&) { return &base; }, {});
  EXPECT_EQ(found.runs.size(), 1U);
  ASSERT_EQ(found.skipped.size(), 1U) << "the same recording twice is no second recording";
  EXPECT_EQ(found.skipped[0].run, "grip");
  EXPECT_EQ(found.skipped[0].why, "another recording has the same name: rename " + two + "/grip");
}

TEST_F(FoundRuns, ARecordingWithTheNameOfAnEarlierRecordingIsSkippedWithAReason) {
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const auto base_of = [&](const std::string&) { return &base; };
  const std::string first = run("one/grip", R"({"started_at": "2026-11-30T07:00:00Z", "state": "complete"})");
  const RunScores earlier = score_runs({first}, base_of, {});
  ASSERT_EQ(earlier.runs.size(), 1U);
  const std::string second =
      run("two/grip", R"({"started_at": "2026-11-30T08:00:00Z", "state": "complete"})");
  const RunScores found = score_runs({first, second}, base_of, earlier.runs);
  EXPECT_TRUE(found.runs.empty());
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped[0].why, "another recording has the same name: rename " + second);
}

TEST_F(FoundRuns, ANamesakeIsAlsoFoundIfOnlyOneStartTimeIsKnown) {
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const auto base_of = [&](const std::string&) { return &base; };
  const std::string first = run("one/grip", R"({"started_at": "2026-11-30T07:00:00Z", "state": "complete"})");
  const RunScores earlier = score_runs({first}, base_of, {});
  const std::string second = run("two/grip", "");
  ASSERT_TRUE(write_file(second + "/run.csv",
                         read_file(second + "/run.csv", largest_health_file).value() + "2.0,left,20,0.2\n"));
  const RunScores found = score_runs({second}, base_of, earlier.runs);
  EXPECT_TRUE(found.runs.empty());
  ASSERT_EQ(found.skipped.size(), 1U);
}

TEST_F(FoundRuns, AFolderThatCannotBeReadIsARecording) {
  std::filesystem::create_directories(folder / "loop");
  std::filesystem::create_symlink("run.csv", folder / "loop/run.csv");  // a loop, which gives ELOOP
  EXPECT_EQ(find_runs({folder.string()}), std::vector<std::string>{(folder / "loop").string()});
}

TEST_F(FoundRuns, ARunCsvBesideARunJsonIsTheRecordingOfItsFolder) {
  const std::string first = run("1", R"({"started_at": "2026-11-30T07:00:00Z", "state": "complete"})");
  const std::string second = run("2", "");
  EXPECT_EQ(find_runs({first + "/run.csv", second + "/run.csv"}),
            (std::vector<std::string>{first, second + "/run.csv"}));
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const auto base_of = [&](const std::string&) { return &base; };
  const RunScores found = score_runs(find_runs({first + "/run.csv"}), base_of, {});
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(found.runs[0].run, "1");
  EXPECT_EQ(found.runs[0].started_at, "2026-11-30T07:00:00Z");
}

TEST_F(FoundRuns, WithoutStartTimesADifferentLogIsASecondRecordingWithTheSameName) {
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const auto base_of = [&](const std::string&) { return &base; };
  for (const std::string story : {"", R"({"state": "complete"})"}) {
    const std::string name = story.empty() ? "log" : "virtual";
    const std::string first = run("one/" + name, story), copy = run("copy/" + name, story);
    const std::string second = run("two/" + name, story);
    std::string csv = *read_file(second + "/run.csv", 1'000'000);
    csv.replace(csv.rfind("0.1\n"), 3, "0.2");
    ASSERT_TRUE(write_file(second + "/run.csv", csv));
    std::string scores;
    for (const ScoredRun& scored : score_runs({first}, base_of, {}).runs) scores += line_of(scored);
    const RunScores found = score_runs({first, copy, second}, base_of, read_scores(scores));
    EXPECT_TRUE(found.runs.empty());
    ASSERT_EQ(found.skipped.size(), 1U) << "an equal log is the same recording";
    EXPECT_EQ(found.skipped[0].why, "another recording has the same name: rename " + second);
  }
}

TEST_F(FoundRuns, ALineWithoutAHashIsTheScoreOfEachRecordingWithItsName) {
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const auto base_of = [&](const std::string&) { return &base; };
  const std::string path = run("log", "");
  RunScores earlier = score_runs({path}, base_of, {});
  ASSERT_EQ(earlier.runs.size(), 1U);
  EXPECT_EQ(earlier.runs[0].log_hash.size(), 12U);
  earlier.runs[0].log_hash = "";
  EXPECT_EQ(line_of(earlier.runs[0]).find("log_hash"), std::string::npos);
  const RunScores found = score_runs({path}, base_of, earlier.runs);
  EXPECT_TRUE(found.runs.empty());
  EXPECT_TRUE(found.skipped.empty());
}

TEST_F(FoundRuns, ASeparatorAtTheEndOfAPathDoesNotChangeTheName) {
  const std::string a = run("a", "") + "/", b = run("b", "") + "/";
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const RunScores found =
      score_runs(find_runs({a, b, folder.string() + "/b"}), [&](const std::string&) { return &base; }, {});
  EXPECT_TRUE(found.skipped.empty());
  ASSERT_EQ(found.runs.size(), 2U);
  EXPECT_EQ(found.runs[1].run, "b");
  // A known recording is not read again.
  EXPECT_TRUE(score_runs(
                  {a, b}, [&](const std::string&) { return &base; }, found.runs)
                  .runs.empty());
}

TEST_F(FoundRuns, MissingRecordingIsSkippedWithAReason) {
  const FingerBase base{score_base(sysid::loaded("bench_twin"), 60), "b"};
  const std::string missing = (folder / "missing").string();
  const RunScores found = score_runs(find_runs({missing}), [&](const std::string&) { return &base; }, {});
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped[0].run, "missing");
  EXPECT_NE(found.skipped[0].why.find(missing), std::string::npos) << found.skipped[0].why;
}

TEST(ScoredRun, LatestScoreOfTheCurrentBaselineIsKept) {
  const FingerBase replaced{{}, "new"};
  const FingerBase kept_since{{}, "old"};
  const BaseOf base_of = [&](const std::string& finger) -> const FingerBase* {
    if (finger == "middle") return nullptr;
    return finger == "left" ? &replaced : &kept_since;
  };
  ScoredRun again = example("run-1", "right", "old");
  again.score[sysid::HealthNumber::gain] = 30;
  const auto kept = current({example("run-1", "left", "old"), example("run-1", "right", "old"),
                             example("run-2", "left", "new"), example("run-2", "middle", "old"), again},
                            base_of);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].score[sysid::HealthNumber::gain], 30);
  EXPECT_EQ(kept[1].run, "run-2");
}

}  // namespace
}  // namespace softgrip::sysid::health::scored_run_test
