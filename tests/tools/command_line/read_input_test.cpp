#include "base/files.h"
#include "tools/command_line/input_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

namespace softgrip::tools::read_input_test {
namespace {

std::optional<int> refused(const std::string& path, document::Problems& problems) {
  problems.add({path, {1, 1}, {}, "it is no number", {}});
  return std::nullopt;
}

std::string file_in(const ScratchFolder& folder) {
  const std::string path = folder.path() + "/input.txt";
  std::ofstream(path) << "7\n";
  return path;
}

TEST(ReadInput, ReturnsWhatTheReaderReturns) {
  const ScratchFolder folder;
  const std::string path = file_in(folder);
  const auto read = read_input(path, [&](const std::string& file, document::Problems&) {
    EXPECT_EQ(file, path);
    return std::optional(7);
  });
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, 7);
}

TEST(ReadInput, PrintsTheProblemsOfARefusedFile) {
  const ScratchFolder folder;
  ::testing::internal::CaptureStderr();
  const auto read = read_input(file_in(folder), refused);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("input.txt:1:1"), std::string::npos);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error(), ExitCode::input_refused);
}

TEST(ReadInput, ReportsAFileThatCannotBeOpenedAsAnIoError) {
  const ScratchFolder folder;
  ::testing::internal::CaptureStderr();
  const auto read = read_input(folder.path() + "/none.txt", refused);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("none.txt"), std::string::npos);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error(), ExitCode::io);
}

}  // namespace
}  // namespace softgrip::tools::read_input_test
