#include "tools/commands/baseline_folder.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/daemon/temporary_folder.h"
#include "tools/commands/diagnose_change.h"

namespace softgrip::tools {
namespace {

class BaselineFolder : public testing::Test {
 protected:
  BaselineFolder() {
    EXPECT_TRUE(write_file(folder_ + "/tp1.csv", "a log\n"));
    sysid::Log log;
    log.path = folder_ + "/tp1.csv";
    logs_ = {log};
  }

  daemon::testing::TemporaryFolder temporary_;
  std::string folder_ = temporary_.path();
  std::vector<sysid::Log> logs_;
};

TEST_F(BaselineFolder, WhatIsWrittenIsReadBack) {
  ASSERT_TRUE(write_baseline(folder_ + "/base", logs_, {}, {{"schema", 1}}));
  const auto baseline = read_baseline(folder_ + "/base");
  ASSERT_TRUE(baseline) << baseline.error();
  ASSERT_EQ(baseline->logs.size(), 1U);
  EXPECT_EQ(*read_file(baseline->logs[0], 100), "a log\n");
}

TEST_F(BaselineFolder, WhatWasChangedIsRefusedByName) {
  ASSERT_TRUE(write_baseline(folder_ + "/base", logs_, {}, {{"schema", 1}}));
  ASSERT_TRUE(write_file(folder_ + "/base/model.yaml", "another"));
  const auto baseline = read_baseline(folder_ + "/base");
  ASSERT_FALSE(baseline);
  EXPECT_NE(baseline.error().find("model.yaml"), std::string::npos) << baseline.error();
}

TEST_F(BaselineFolder, AnotherFilesJsonIsRefused) {
  for (const char* const text : {"", "[]", "{\"logs\": 3}", "{\"logs\": [{}], \"model\": {}}"}) {
    ASSERT_TRUE(write_file(folder_ + "/baseline.json", text));
    EXPECT_FALSE(read_baseline(folder_)) << text;
  }
}

TEST_F(BaselineFolder, AChangeOfNothingIsRefused) {
  EXPECT_EQ(run_change({{}, {}, {}, {}, folder_, {}, {}, true}), ExitCode::input_refused);
}

}  // namespace
}  // namespace softgrip::tools
