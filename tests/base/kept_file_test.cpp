#include "base/kept_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "base/files.h"

namespace softgrip::kept_file_test {
namespace {

namespace fs = std::filesystem;

class KeptFileTest : public testing::Test {
 protected:
  KeptFileTest() {
    fs::create_directories(folder_);
    EXPECT_TRUE(create_file(path_, "old"));
  }
  ~KeptFileTest() override { fs::remove_all(folder_); }
  static std::string text(const fs::path& path) { return read_file(path.string(), 1000).value_or("?"); }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  fs::path folder_ = fs::temp_directory_path() / ("softgrip_files_" + std::to_string(::getpid()));
  std::string path_ = (folder_ / "rig.yaml").string();
};

TEST_F(KeptFileTest, AFileThatIsThereIsNotCreated) {
  const auto again = create_file(path_, "new");
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().find("File exists"), std::string::npos) << again.error();
  EXPECT_EQ(text(path_), "old");
}

TEST_F(KeptFileTest, AReplacedFileKeepsItsPermissions) {
  ASSERT_EQ(::chmod(path_.c_str(), 0640), 0);
  ASSERT_TRUE(replace_file(path_, "new"));
  EXPECT_EQ(text(path_), "new");
  struct ::stat now {};
  ASSERT_EQ(::stat(path_.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0640U);
  EXPECT_EQ(count(), 1U) << "nothing is left beside it";
}

TEST_F(KeptFileTest, ALinkStaysALink) {
  const fs::path link = folder_ / "link.yaml";
  fs::create_symlink("rig.yaml", link);
  ASSERT_TRUE(replace_file(link.string(), "new"));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text(path_), "new");
}

TEST_F(KeptFileTest, WhatIsNotThereIsNotReplaced) {
  EXPECT_FALSE(replace_file((folder_ / "absent.yaml").string(), "new"));
  EXPECT_EQ(count(), 1U);
}

/// As on a full disk: the kernel takes only so many bytes.
TEST_F(KeptFileTest, WhatDoesNotFitLeavesTheOldFile) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const signal = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string large(5000, 'x');
  const auto replaced = replace_file(path_, large);
  const auto created = create_file((folder_ / "other.yaml").string(), large);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, signal);
  EXPECT_FALSE(replaced);
  EXPECT_FALSE(created);
  EXPECT_EQ(text(path_), "old");
  EXPECT_EQ(count(), 1U) << "no half of a file either";
}

}  // namespace
}  // namespace softgrip::kept_file_test
