#include "tools/commands/baseline_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "sysid/changes/baseline_folder.h"
#include "tools/commands/diagnose_change.h"

namespace softgrip::tools::baseline_folder_test {
namespace {

class BaselineFolder : public ::testing::Test {
 protected:
  BaselineFolder() {
    EXPECT_TRUE(write_file(folder_ + "/tp1.csv", "a log\n"));
    sysid::Log log;
    log.path = folder_ + "/tp1.csv";
    contents_.healthy = files_of({log}).value();
  }

  ScratchFolder temporary_;
  std::string folder_ = temporary_.path();
  BaselineContents contents_;
};

TEST_F(BaselineFolder, ReturnsTheWrittenLogs) {
  ASSERT_TRUE(write_baseline(folder_ + "/base", contents_, {{"schema", 1}}));
  const auto baseline = sysid::read_baseline(folder_ + "/base");
  ASSERT_TRUE(baseline) << baseline.error();
  ASSERT_EQ(baseline->logs.size(), 1U);
  EXPECT_EQ(*read_file(baseline->logs[0], 100), "a log\n");
  EXPECT_TRUE(baseline->second.empty());
  EXPECT_TRUE(baseline->gauge.empty());
}

TEST_F(BaselineFolder, ChecksTheIntegrityOfTheSecondRunAndTheGaugeFile) {
  contents_.second = {{"again.csv", "another log\n"}};
  contents_.gauge = BaselineFile{"blocks.csv", "gauge_mm,displacement_mm\n"};
  for (const char* const name : {"second_1.csv", "gauge.csv"}) {
    ASSERT_TRUE(write_baseline(folder_ + "/base", contents_, {{"schema", 1}}));
    const auto baseline = sysid::read_baseline(folder_ + "/base");
    ASSERT_TRUE(baseline) << baseline.error();
    ASSERT_EQ(baseline->second.size(), 1U);
    EXPECT_EQ(*read_file(baseline->second[0], 100), "another log\n");
    EXPECT_EQ(*read_file(baseline->gauge, 100), "gauge_mm,displacement_mm\n");
    ASSERT_TRUE(write_file(folder_ + "/base/" + name, "touched"));
    const auto touched = sysid::read_baseline(folder_ + "/base");
    ASSERT_FALSE(touched);
    EXPECT_NE(touched.error().find(name), std::string::npos) << touched.error();
  }
}

TEST_F(BaselineFolder, WritingLeavesNoTemporaryFolder) {
  ASSERT_TRUE(write_file(folder_ + "/file", "no folder"));
  EXPECT_FALSE(write_baseline(folder_ + "/file/base", contents_, {{"schema", 1}}));
  ASSERT_TRUE(write_baseline(folder_ + "/base/", contents_, {{"schema", 1}}));
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++entries;
  EXPECT_EQ(entries, 3U) << "expected: tp1.csv, file and base";
}

TEST_F(BaselineFolder, RefusalNamesTheModifiedFile) {
  ASSERT_TRUE(write_baseline(folder_ + "/base", contents_, {{"schema", 1}}));
  ASSERT_TRUE(write_file(folder_ + "/base/model.yaml", "another"));
  const auto baseline = sysid::read_baseline(folder_ + "/base");
  ASSERT_FALSE(baseline);
  EXPECT_NE(baseline.error().find("model.yaml"), std::string::npos) << baseline.error();
}

TEST_F(BaselineFolder, RefusesAMalformedBaselineFile) {
  for (const char* const text : {"", "[]", "{\"logs\": 3}", "{\"logs\": [{}], \"model\": {}}"}) {
    ASSERT_TRUE(write_file(folder_ + "/baseline.json", text));
    EXPECT_FALSE(sysid::read_baseline(folder_)) << text;
  }
}

TEST_F(BaselineFolder, ChangeWithoutLogsIsRefused) {
  EXPECT_EQ(run_change({{}, {}, {}, {}, folder_, {}, {}, true}), ExitCode::input_refused);
}

}  // namespace
}  // namespace softgrip::tools::baseline_folder_test
