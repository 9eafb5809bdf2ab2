#include "tools/command_line/output.h"

#include <fcntl.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/descriptor.h"
#include "base/files.h"

namespace softgrip::tools::output_test {
namespace {

namespace fs = std::filesystem;

/// A file with one line that is open at its end, as after `softgrip ... --out /dev/stdout >> file`.
class OpenFile : public ::testing::Test {
 protected:
  OpenFile() : file_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600)) {
    EXPECT_EQ(write_all(file_.get(), "first\n"), 0);
  }
  [[nodiscard]] std::string text() const { return read_file(path_, 1000).value_or("unreadable"); }

  ScratchFolder folder_;
  std::string path_ = folder_.path() + "/file.csv";
  Descriptor file_;
};

TEST_F(OpenFile, IsContinuedThroughALinkToItsDescriptor) {
  const std::string link = folder_.path() + "/stdout";
  fs::create_symlink("/proc/self/fd/" + std::to_string(file_.get()), link);
  EXPECT_TRUE(is_stream(link));
  const auto written = write_output(link, "second\n");
  EXPECT_TRUE(written) << written.error();
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text(), "first\nsecond\n");
}

TEST_F(OpenFile, IsContinuedThroughARelativeLinkInTheFolderOfDescriptors) {
  const std::string descriptors = folder_.path() + "/fd", link = folder_.path() + "/stderr";
  fs::create_directory_symlink("/proc/self/fd", descriptors);
  fs::create_symlink("fd/" + std::to_string(file_.get()), link);
  EXPECT_TRUE(write_output(link, "second\n"));
  EXPECT_EQ(text(), "first\nsecond\n");
}

TEST_F(OpenFile, IsReplacedThroughItsPath) {
  EXPECT_FALSE(is_stream(path_));
  EXPECT_TRUE(write_output(path_, "second\n"));
  EXPECT_EQ(text(), "second\n");
}

TEST_F(OpenFile, IsNoStreamThroughALinkToItsPath) {
  const std::string link = folder_.path() + "/link.csv";
  fs::create_symlink("file.csv", link);
  EXPECT_FALSE(is_stream(link));
  const std::string loop = folder_.path() + "/loop.csv";
  fs::create_symlink("loop.csv", loop);
  EXPECT_FALSE(is_stream(loop));
}

TEST(WriteOutput, NamesAClosedDescriptor) {
  const auto written = write_output("/proc/self/fd/987", "text");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().find("/proc/self/fd/987"), std::string::npos) << written.error();
}

}  // namespace
}  // namespace softgrip::tools::output_test
