#include "rig/socket_path.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace softgrip::rig::socket_path_test {
namespace {

class SocketPath : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& text) {
    const std::string path = folder_ / "rig.yaml";
    std::ofstream(path) << text;
    return path;
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("socket_path_" + std::to_string(::getpid()));
};

TEST_F(SocketPath, IsReadFromARigFileWithOtherErrors) {
  document::Problems problems;
  EXPECT_EQ(socket_path_of(write("nam: x\nsocket: {path: /run/x.sock}\n"), problems), "/run/x.sock");
  EXPECT_EQ(socket_path_of(write("socket: {path: ../x.sock}\n"), problems),
            (folder_.parent_path() / "x.sock").string());
  EXPECT_TRUE(problems.empty()) << problems.format();
}

TEST_F(SocketPath, AMissingPathIsReportedAsAProblem) {
  document::Problems problems;
  EXPECT_FALSE(socket_path_of(write("name: x\n"), problems));
  EXPECT_NE(problems.format().find("does not name a socket"), std::string::npos);
  EXPECT_FALSE(socket_path_of(write("socket: {mode: \"0660\"}\n"), problems));
  EXPECT_FALSE(socket_path_of((folder_ / "absent.yaml").string(), problems));
  EXPECT_EQ(problems.size(), 3U) << problems.format();
}

}  // namespace
}  // namespace softgrip::rig::socket_path_test
