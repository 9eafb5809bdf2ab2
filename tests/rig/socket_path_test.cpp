#include "rig/rig_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/files.h"

namespace softgrip::rig::socket_path_test {
namespace {

class SocketPath : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string path = folder_ / "rig.yaml";
    std::ofstream(path) << text;
    return path;
  }
  const ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
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
