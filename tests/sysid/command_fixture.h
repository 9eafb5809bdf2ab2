#pragma once
// Runs the softgrip program in a temporary folder of the test.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "base/files.h"

namespace softgrip::sysid {

class CommandInFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("softgrip_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs `softgrip ARGUMENTS` and returns the exit code. Writes the standard output to out.txt and the
  /// standard error to err.txt.
  int run(const std::string& arguments) {
    const std::string line =
        "cd '" + folder_.string() + "' && '" SOFTGRIP_PROGRAM "' " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file((folder_ / name).string(), text));
  }
  std::string read(const std::string& name) {
    return read_file((folder_ / name).string(), 20'000'000).value_or("");
  }

  std::filesystem::path folder_;
};

}  // namespace softgrip::sysid
