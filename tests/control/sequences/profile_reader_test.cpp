#include "control/sequences/profile_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace softgrip::control::profile_reader_test {
namespace {

Profile profile_in(const std::string& text, document::Problems& problems) {
  const auto document = document::parse("seq.yaml", text, problems);
  document::MapReader map(document, document.root, problems, "step");
  Profile profile;
  read_profile(map, document, problems, profile);
  return profile;
}

TEST(ProfileReader, ReadsPointsAndCycles) {
  document::Problems problems;
  const Profile profile = profile_in(
      "points: [{time_s: 0, pressure_kpa: 5}, {time_s: 2, pressure_kpa: 9}, {time_s: 3, pressure_kpa: 5}]\n"
      "cycles: 4\n",
      problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  ASSERT_EQ(profile.points.size(), 3U);
  EXPECT_EQ(profile.points[1].time_s, 2);
  EXPECT_EQ(profile.points[1].pressure_kpa, 9);
  EXPECT_EQ(profile.cycles, 4U);
  EXPECT_FALSE(profile.signal);
}

TEST(ProfileReader, ReadsASignalAndItsScale) {
  document::Problems problems;
  const Profile profile = profile_in("signal: tp2\nscale: 0.5\n", problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  EXPECT_EQ(profile.signal, model::SignalName::tp2);
  EXPECT_EQ(profile.scale, 0.5);
  EXPECT_TRUE(profile.points.empty());
}

TEST(ProfileReader, RefusesAPressureOutsideTheRange) {
  document::Problems problems;
  const std::string above = std::to_string(step_ranges::pressure_kpa.upper + 1);
  profile_in("points: [{time_s: 0, pressure_kpa: 5}, {time_s: 2, pressure_kpa: " + above + "}]\n", problems);
  EXPECT_EQ(problems.size(), 1U) << problems.format();
}

}  // namespace
}  // namespace softgrip::control::profile_reader_test
