#include "tools/recordings/recording_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/files.h"

namespace softgrip::tools::recording_picture_test {
namespace {

const std::string csv =
    "time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reference_mm,state\n"
    "0,left,0,0,0.1,,idle\n"
    "0,right,0,0,0.1,,idle\n"
    "0.01,left,10,3,9,3.3,running\n"
    "0.01,right,10,,9,4,running\n"
    "0.02,left,20,6,19,5.6,running\n"
    "0.02,right,20,8,19,8,running\n";

class RecordingPicture : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(write_file(folder / name, text));
  }
  [[nodiscard]] tl::expected<sysid::Recording, std::string> read() const {
    document::Problems problems;
    return sysid::read_recording(folder, problems);
  }

  const ScratchFolder scratch;
  std::filesystem::path folder = scratch.path();
};

TEST_F(RecordingPicture, SplitsChannelsAndShowsEvents) {
  write("run.csv", csv);
  write("run.json", R"({"software_version": "1", "sequence": {"name": "pick <b>"},
      "events": [{"time_s": 0.01, "kind": "grip_result", "channel": "left", "code": "HOLDING", "text": "x"}, {"x": 1}]})");
  const auto recording = read();
  ASSERT_TRUE(recording);
  ASSERT_EQ(recording->channels.size(), 2U);
  EXPECT_EQ(recording->channels[1].channel, "right");
  EXPECT_EQ(recording->channels[1].displacement_mm[2], 8);
  EXPECT_EQ(recording->sequence, "pick <b>");
  ASSERT_EQ(recording->events.size(), 1U);
  EXPECT_EQ(recording->events[0].code, "HOLDING");

  const Tracking left = tracking_of(recording->channels[0]);
  EXPECT_EQ(left.free_samples, 2U);
  EXPECT_NEAR(left.free_rmse_mm, std::sqrt((0.3 * 0.3 + 0.4 * 0.4) / 2), 1e-12);
  EXPECT_NEAR(left.free_largest_mm, 0.4, 1e-12);
  EXPECT_FALSE(left.grips_known);
  EXPECT_EQ(tracking_of(recording->channels[1]).free_samples, 1U)
      << "a sample without a reading does not count";

  const std::string picture = sysid::svg_file_of(figure_of(*recording));
  EXPECT_EQ(picture.rfind("<svg", 0), 0U);
  EXPECT_NE(picture.find("HOLDING"), std::string::npos);
  EXPECT_NE(picture.find("right: displacement"), std::string::npos);
  EXPECT_EQ(picture.find("<b>"), std::string::npos) << "texts are escaped";
}

// During a grip, the reference is beyond the surface of the object. The finger stops 4 mm before the
// reference, so these 4 mm are not a tracking error.
TEST_F(RecordingPicture, ExcludesGripsFromTheTrackingErrorInFreeMotion) {
  write("run.csv",
        "time_s,pressure_command_kpa,displacement_mm,reference_mm,state,step,result\n"
        "0,0,0,,resynchronising,0,none\n"
        "0.1,10,5.7,6,running,0,none\n"
        "0.2,10,6.4,6,running,0,none\n"
        "0.3,20,8,8,running,1,none\n"
        "0.4,20,8.5,12,running,1,none\n"
        "0.5,20,8.5,12.5,running,2,holding\n"
        "0.6,20,8.5,,running,3,holding\n"
        "0.7,20,2,,idle,3,released\n");
  const auto recording = read();
  ASSERT_TRUE(recording);
  const Tracking tracking = tracking_of(recording->channels[0]);
  EXPECT_TRUE(tracking.grips_known);
  EXPECT_EQ(tracking.free_samples, 2U);
  EXPECT_NEAR(tracking.free_rmse_mm, std::sqrt((0.3 * 0.3 + 0.4 * 0.4) / 2), 1e-12);
  EXPECT_NEAR(tracking.free_largest_mm, 0.4, 1e-12);
  EXPECT_EQ(tracking.gripping_samples, 3U);
  EXPECT_NEAR(tracking.gripping_largest_mm, 4, 1e-12);
  EXPECT_EQ(to_text(tracking),
            "free motion: RMSE 0.354 mm, largest 0.4 mm; gripping: up to 4 mm below the reference");
  const std::string picture = sysid::svg_file_of(figure_of(*recording));
  EXPECT_NE(picture.find("in free motion RMSE 0.354 mm, largest 0.4 mm"), std::string::npos);
  EXPECT_NE(picture.find(">gripping<"), std::string::npos);
}

// If a grip finds no object, the whole grip is a free motion.
TEST_F(RecordingPicture, AGripWithoutAPartCountsAsFreeMotion) {
  write("run.csv",
        "time_s,pressure_command_kpa,displacement_mm,reference_mm,state,step,result\n"
        "0,10,6,6,running,0,none\n"
        "0.1,10,16.8,17,running,1,none\n"
        "0.2,10,16.9,,running,3,no_part\n"
        "0.3,10,3,,running,3,no_part\n");
  const auto recording = read();
  ASSERT_TRUE(recording);
  const Tracking tracking = tracking_of(recording->channels[0]);
  EXPECT_EQ(tracking.free_samples, 2U);
  EXPECT_EQ(tracking.gripping_samples, 0U);
}

TEST_F(RecordingPicture, ReadsATruncatedRecording) {
  write("run.csv", csv + "0.03,left,3");
  write("run.json", "{\"schema\": 1, \"eve");
  const auto recording = read();
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->channels[0].size(), 3U);
  EXPECT_TRUE(recording->events.empty());
  EXPECT_NE(sysid::svg_file_of(figure_of(*recording)).find("left: pressure"), std::string::npos);
}

TEST_F(RecordingPicture, DrawsALogWithoutEvents) {
  write("run.csv", "time_s,pressure_command_kpa,displacement_mm\n0,0,0\n0.1,5,1\n0.2,9,2\n");
  document::Problems problems;
  const auto recording = sysid::read_recording(folder / "run.csv", problems);
  ASSERT_TRUE(recording);
  EXPECT_NE(sysid::svg_file_of(figure_of(*recording)).find("displacement in millimetres"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::tools::recording_picture_test
