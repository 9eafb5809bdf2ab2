#include "sysid/health/finger_track.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::health::finger_track_test {
namespace {

std::vector<ScoredRun> runs_of(const std::string& finger, const std::vector<std::string>& names,
                               const std::string& started_at = {}) {
  std::vector<ScoredRun> runs;
  for (const std::string& name : names) runs.push_back({name, finger, started_at, {}, {}, {}});
  return runs;
}

/// Returns the moments of the groups of a track.
std::vector<std::size_t> moments_of(const FingerTrack& track) {
  std::vector<std::size_t> moments;
  for (const RunGroup& group : track.groups) moments.push_back(group.moment);
  return moments;
}

TEST(FingerTrack, ARunOfOneFingerKeepsItsPlaceAmongUndatedRuns) {
  const std::vector<ScoredRun> left = runs_of("left", {"g2", "g3", "g10"}),
                               right = runs_of("right", {"g1", "g2", "g9", "g10", "g11"});
  std::vector<FingerTrack> tracks{track_of("left", left, {}, {}, false),
                                  track_of("right", right, {}, {}, false)};
  EXPECT_EQ(place_in_time(tracks), 6U);
  EXPECT_EQ(moments_of(tracks[0]), (std::vector<std::size_t>{1, 2, 4}));
  EXPECT_EQ(moments_of(tracks[1]), (std::vector<std::size_t>{0, 1, 3, 4, 5}));
}

TEST(FingerTrack, DatedRunsAreInTheOrderOfTheirStarts) {
  const std::vector<ScoredRun> left = runs_of("left", {"b"}, "2026-11-03T10:00:00Z"),
                               right = runs_of("right", {"a"}, "2026-11-02T10:00:00Z");
  std::vector<FingerTrack> tracks{track_of("left", left, {}, {}, false),
                                  track_of("right", right, {}, {}, false)};
  EXPECT_EQ(place_in_time(tracks), 2U);
  EXPECT_EQ(tracks[0].groups.front().moment, 1U);
  EXPECT_EQ(tracks[1].groups.front().moment, 0U);
}

}  // namespace
}  // namespace softgrip::sysid::health::finger_track_test
