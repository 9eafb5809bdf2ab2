#include "tools/health/scored_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/health/run_search.h"

namespace softgrip::tools::health {
namespace {

ScoredRun example(const std::string& run, const std::string& finger, const std::string& baseline) {
  ScoredRun scored{run, finger, "2026-11-22T01:02:03Z", "pick 12345678 hold_s=5", baseline, {}};
  scored.score[sysid::HealthNumber::gain] = 31.25;
  return scored;
}

TEST(ScoredRun, ALineReadsBackAsItWasAndWhatIsAbsentStaysAbsent) {
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

TEST(ScoredRun, ALineThatWasCutOffCostsItselfAlone) {
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

TEST(ScoredRun, OnlyScoresByTodaysBaselineCountAndTheLastOfThem) {
  const BaseOf base_of = [](const std::string& finger) -> std::optional<FingerBase> {
    if (finger == "middle") return std::nullopt;
    return FingerBase{{}, finger == "left" ? "new" : "old"};
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
}  // namespace softgrip::tools::health
