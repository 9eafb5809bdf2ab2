// Tests that a calibration replaces the calibration points in the rig file and leaves all other lines
// unchanged.

#include "tools/commissioning/calibration_results.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "rig/rig_file.h"
#include "tests/support/files.h"

namespace softgrip::tools::calibrate::rig_update_test {
namespace {

namespace fs = std::filesystem;

Line line(const drivers::TwoPoints& points) {
  Line found;
  found.points = points;
  found.error = 0.0213;
  found.noise = 0.03;
  return found;
}

class RigUpdateTest : public ::testing::Test {
 protected:
  RigUpdateTest() {
    std::string text = test::text_of(config_ / "rig.yaml");
    const std::string models = (config_ / "models/").string();
    for (std::size_t at = text.find("models/"); at != std::string::npos;
         at = text.find("models/", at + models.size())) {
      text.replace(at, 7, models);
    }
    save(text);
  }
  void save(const std::string& text) {
    std::ofstream(path_) << text;
    document::Problems problems;
    const auto read = rig::load_rig(path_.string(), problems);
    ASSERT_TRUE(read) << problems.format();
    rig_ = *read;
    text_ = text;
  }
  [[nodiscard]] std::string replaced(const std::string& from, const std::string& to) const {
    std::string text = text_;
    EXPECT_NE(text.find(from), std::string::npos) << from;
    return text.replace(text.find(from), from.size(), to);
  }
  [[nodiscard]] Results sensor(const drivers::TwoPoints& points) const {
    Results results;
    results.date = "2026-11-20";
    results.sensor = line(points);
    return results;
  }
  fs::path config_ = fs::path(SOFTGRIP_SOURCE_DIR) / "config";
  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  fs::path path_ = folder_ / "rig.yaml";
  std::string text_;
  rig::RigFile rig_;
};

constexpr drivers::TwoPoints found{2.03, 5.1, 7.41, 32.25};

TEST_F(RigUpdateTest, AddsTheCalibrationPointsToTheChannel) {
  const auto changed = updated_rig(text_, rig_, sensor(found));
  ASSERT_TRUE(changed) << changed.error();
  EXPECT_EQ(*changed,
            replaced("    sensor: {input: 0}",
                     "    # softgrip calibrate 2026-11-20: error 0.0213 mm, noise of a reading 0.03 mm\n"
                     "    sensor: {input: 0, at_v: [2.03, 7.41], is_mm: [5.1, 32.25]}"));
}

TEST_F(RigUpdateTest, ASecondCalibrationReplacesPointsAndComment) {
  save(updated_rig(text_, rig_, sensor(found)).value());
  Results next = sensor({2, 5, 7.5, 32});
  next.date = "2027-01-02";
  const auto changed = updated_rig(text_, rig_, next);
  ASSERT_TRUE(changed) << changed.error();
  EXPECT_NE(changed->find("# softgrip calibrate 2027-01-02"), std::string::npos);
  EXPECT_EQ(changed->find("2026-11-20"), std::string::npos);
  EXPECT_NE(changed->find("sensor: {input: 0, at_v: [2, 7.5], is_mm: [5, 32]}"), std::string::npos)
      << *changed;
}

TEST_F(RigUpdateTest, UpdatesValveAndMonitorOfTheSecondChannelOnly) {
  Results results;
  results.date = "2026-11-20";
  results.channel = 1;
  results.valve = ValveResult{line({1, 9.5, 7, 69}), line({1, 10.5, 7, 70}), false};
  const auto changed = updated_rig(text_, rig_, results);
  ASSERT_TRUE(changed) << changed.error();
  EXPECT_NE(changed->find("    valve: {output: 1, at_v: [1, 7], is_kpa: [9.5, 69]}\n"), std::string::npos)
      << *changed;
  EXPECT_NE(changed->find("    pressure_monitor: {input: 5, at_v: [1, 7], is_kpa: [10.5, 70]}\n"),
            std::string::npos);
  EXPECT_NE(changed->find("    valve: {output: 0}\n"), std::string::npos)
      << "the lines of the other channel must not change";
}

TEST_F(RigUpdateTest, PointsThatTheRigRefusesAreNotWritten) {
  Results results;
  results.date = "2026-11-20";
  results.valve = ValveResult{line({5, 10, 5, 40}), std::nullopt, true};
  const auto changed = updated_rig(text_, rig_, results);
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().find("would be refused"), std::string::npos) << changed.error();
  EXPECT_NE(changed.error().find("rig.yaml:"), std::string::npos);
}

TEST_F(RigUpdateTest, WritesTheNewFileAndKeepsABackupOfTheOldOne) {
  const auto backup = write_rig(rig_, replaced("name: simulated", "name: other"));
  ASSERT_TRUE(backup) << backup.error();
  EXPECT_EQ(test::text_of(*backup), text_);
  EXPECT_EQ(test::text_of(path_), replaced("name: simulated", "name: other"));
  EXPECT_NE(fs::path(*backup).extension(), ".yaml")
      << "softgrip check FOLDER must not read the backup file as a rig file";
}

TEST_F(RigUpdateTest, DoesNotOverwriteAFileThatWasChangedMeanwhile) {
  std::ofstream(path_, std::ios::app) << "# by hand\n";
  const auto backup = write_rig(rig_, "name: x\n");
  ASSERT_FALSE(backup);
  EXPECT_NE(backup.error().find("was changed while"), std::string::npos);
  EXPECT_EQ(test::text_of(path_), text_ + "# by hand\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(RigUpdateTest, ACalibrationNearTheOldOneCausesNoWarning) {
  Results results = sensor({2, 5.1, 8, 35.3});
  results.valve = ValveResult{line({1, 10, 7, 71}), std::nullopt, true};
  EXPECT_TRUE(plausibility_warnings(rig_, results).empty());
}

TEST_F(RigUpdateTest, ACalibrationFarFromTheOldOneCausesAWarning) {
  Results results = sensor({2, 5, 8, 26});
  results.valve = ValveResult{line({0, 0, 10, 75}), line({0, 0, 10, 130}), false};
  const auto warnings = plausibility_warnings(rig_, results);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_EQ(warnings[0],
            "valve: at the point where the calibration line in the rig file gives 60 kPa, the new line gives "
            "45 kPa, a difference of "
            "25 % of the range");
  EXPECT_EQ(warnings[1].rfind("pressure monitor: ", 0), 0U);
  EXPECT_EQ(warnings[2].rfind("sensor: ", 0), 0U);
}

TEST_F(RigUpdateTest, WarnsIfTheGaugeTravelDiffersFromTheModelPrediction) {
  const auto warnings_with = [&](double travel_mm) {
    Results results = sensor({2, 5, 2 + travel_mm / 5, 5 + travel_mm});
    results.motion = Motion{10, 40, 3, 12};
    return plausibility_warnings(rig_, results);
  };
  ASSERT_FALSE(warnings_with(3).empty());
  EXPECT_NE(warnings_with(3)[0].find("the gauge reading changes by 3 mm, but the model predicts "),
            std::string::npos)
      << warnings_with(3)[0];
  const std::string sentence = warnings_with(3)[0];
  const double model_mm = std::stod(sentence.substr(sentence.find("predicts ") + 9));
  EXPECT_GT(model_mm, 8);
  EXPECT_TRUE(warnings_with(model_mm).empty());
  EXPECT_TRUE(warnings_with(0.85 * model_mm).empty());
  EXPECT_FALSE(warnings_with(1.3 * model_mm).empty());
}

}  // namespace
}  // namespace softgrip::tools::calibrate::rig_update_test
