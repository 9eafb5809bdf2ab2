#include "tools/commands/series_output.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace softgrip::tools::series_output_test {
namespace {

TEST(SeriesOutput, WritesTwoFoldersForALogGivenTwice) {
  const auto folder = std::filesystem::temp_directory_path() / "softgrip_series_output_test";
  sysid::LogSeries series;
  series.name = "tp1";
  ASSERT_TRUE(write_series(folder.string(), {series, series}));
  EXPECT_TRUE(std::filesystem::exists(folder / "tp1/series.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "tp1 (2)/series.csv"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace softgrip::tools::series_output_test
