#include "tools/commands/series_output.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace softgrip::tools::series_output_test {
namespace {

TEST(SeriesOutput, WritesTwoFoldersForALogGivenTwice) {
  const auto folder = std::filesystem::temp_directory_path() / "softgrip_series_output_test";
  LogSeries series;
  series.name = "tp1";
  ASSERT_TRUE(write_series(folder.string(), {series, series}));
  EXPECT_TRUE(std::filesystem::exists(folder / "tp1/series.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "tp1 (2)/series.csv"));
  std::filesystem::remove_all(folder);
}

TEST(Series, MissingValuesAreEmptyCsvCells) {
  sysid::Log log;
  log.name = "run";
  log.time_s = {0, 0.01, 0.02};
  log.displacement_mm = {1, std::nan(""), 3};
  sysid::Record record;
  record.time_s = log.time_s;
  record.drive_kpa = {10, 20, 30};
  record.reading_mm = {1, std::nan(""), std::nan("")};
  LogSeries series = series_of(log, record, false);
  series.predicted = {{"given", {0.5, 1.5, 2.5}}, {"extended", {1, 2, std::nan("")}}};
  EXPECT_EQ(series_csv(series),
            "time_s,drive_kpa,measured_mm,predicted_given_mm,residual_given_mm,predicted_extended_mm,"
            "residual_extended_mm,"
            "held_out\n"
            "0,10,1,0.5,0.5,1,0,0\n"
            "0.01,20,,1.5,,2,,0\n"
            "0.02,30,3,2.5,0.5,,,1\n");
  EXPECT_EQ(series_of(log, record, true).held_out, (std::vector<bool>{true, false, true}));
}

TEST(Series, AveragedReadingsUseTheSamplesOfTheRecord) {
  sysid::Log log;
  log.time_s = {0, 0.001, 0.002, 0.003};
  log.displacement_mm = {1, 2, 3, 4};
  sysid::Record record;
  record.time_s = {0, 0.002};
  record.drive_kpa = {10, 20};
  record.reading_mm = {1, 3.1};
  const LogSeries series = series_of(log, record, false);
  EXPECT_EQ(series.time_s, record.time_s);
  EXPECT_EQ(series.measured_mm, record.reading_mm);
  EXPECT_EQ(series.held_out, (std::vector<bool>{false, false}));
}

TEST(Series, PathStaysWithinTheOutputFolder) {
  EXPECT_EQ(series_folder("tp1"), "tp1");
  EXPECT_EQ(series_folder("2026-11-20T04-21-40Z_pick/left (2)"), "2026-11-20T04-21-40Z_pick_left (2)");
  EXPECT_EQ(series_folder(".."), "log");
  EXPECT_EQ(series_folder("../../etc"), ".._.._etc");
}

}  // namespace
}  // namespace softgrip::tools::series_output_test
