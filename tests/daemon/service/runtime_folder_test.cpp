#include "daemon/service/runtime_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/daemon/temporary_folder.h"

namespace softgrip::daemon::runtime_folder_test {
namespace {

namespace fs = std::filesystem;

class RuntimeFolderTest : public ::testing::Test {
 protected:
  RuntimeFolderTest() : place_(parent_.path() + "/mine") {}
  [[nodiscard]] RuntimeFolder folder() const {
    auto opened = RuntimeFolder::open({place_});
    EXPECT_TRUE(opened) << opened.error();
    return std::move(*opened);
  }
  [[nodiscard]] static mode_t mode_of(const std::string& path) {
    struct stat status {};
    EXPECT_EQ(::stat(path.c_str(), &status), 0) << path;
    return status.st_mode & 07777U;
  }

  testing::TemporaryFolder parent_;
  std::string place_;
};

TEST_F(RuntimeFolderTest, WhatItMakesIsItsOwnersAlone) {
  const RuntimeFolder mine = folder();
  EXPECT_EQ(mine.path(), place_);
  EXPECT_EQ(mode_of(place_), 0700U);
  ASSERT_TRUE(mine.lock_file("a.lock"));
  ASSERT_TRUE(mine.put("b.json", "text"));
  EXPECT_EQ(mode_of(place_ + "/a.lock"), 0600U);
  EXPECT_EQ(mode_of(place_ + "/b.json"), 0600U);
}

TEST_F(RuntimeFolderTest, APlaceThatOthersCanChangeIsPassedOver) {
  fs::create_directory(place_);
  const std::string better = parent_.path() + "/better";
  for (const mode_t mode : {0777U, 0770U, 0722U}) {
    ASSERT_EQ(::chmod(place_.c_str(), mode), 0);
    EXPECT_FALSE(RuntimeFolder::open({place_})) << mode;
    const auto opened = RuntimeFolder::open({place_, better});
    ASSERT_TRUE(opened) << opened.error();
    EXPECT_EQ(opened->path(), better);
  }
}

TEST_F(RuntimeFolderTest, AnotherUsersPlaceIsPassedOver) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can change the owner of a folder";
  fs::create_directory(place_);
  ASSERT_EQ(::chown(place_.c_str(), 65534, 65534), 0);
  const auto opened = RuntimeFolder::open({place_});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().find("belongs to user 65534"), std::string::npos) << opened.error();
}

TEST_F(RuntimeFolderTest, ALinkIsNoPlace) {
  fs::create_directory(parent_.path() + "/elsewhere");
  fs::create_directory_symlink(parent_.path() + "/elsewhere", place_);
  EXPECT_FALSE(RuntimeFolder::open({place_}));
}

TEST_F(RuntimeFolderTest, AFileThatIsNotItsOwnIsRefusedAndStays) {
  const RuntimeFolder mine = folder();
  const std::string victim = parent_.path() + "/victim";
  std::ofstream(victim) << "precious";
  ASSERT_EQ(::chmod(victim.c_str(), 0600), 0);
  fs::create_symlink(victim, place_ + "/link");
  fs::create_hard_link(victim, place_ + "/hard");
  std::ofstream(place_ + "/open") << "readable";
  ASSERT_EQ(::chmod((place_ + "/open").c_str(), 0644), 0);
  ASSERT_EQ(::mkfifo((place_ + "/fifo").c_str(), 0600), 0);
  for (const char* name : {"link", "hard", "open", "fifo"}) {
    EXPECT_FALSE(mine.lock_file(name)) << name;
    EXPECT_FALSE(mine.get(name, 1000)) << name;
  }
  ASSERT_TRUE(mine.put("link", "new"));
  EXPECT_FALSE(fs::is_symlink(place_ + "/link")) << "the symbolic link is replaced and not followed";
  std::string text;
  std::ifstream(victim) >> text;
  EXPECT_EQ(text, "precious");
}

TEST_F(RuntimeFolderTest, PutsAWholeFileOrNone) {
  const RuntimeFolder mine = folder();
  const std::string long_text(1'000'000, 'x');
  ASSERT_TRUE(mine.put("file", "old"));
  ASSERT_TRUE(mine.put("file", long_text));
  EXPECT_EQ(mine.get("file", 2'000'000).value(), long_text);
  EXPECT_FALSE(mine.get("file", 999'999)) << "a file above the size limit is not read";
  mine.remove("file");
  EXPECT_FALSE(mine.get("file", 10));
  EXPECT_TRUE(fs::is_empty(place_)) << "no temporary file remains";
}

TEST_F(RuntimeFolderTest, KnowsWhetherANameIsStillTheFile) {
  const RuntimeFolder mine = folder();
  const auto file = mine.lock_file("a");
  ASSERT_TRUE(file) << file.error();
  EXPECT_TRUE(mine.still_names("a", file->get()));
  mine.remove("a");
  EXPECT_FALSE(mine.still_names("a", file->get()));
  ASSERT_TRUE(mine.lock_file("a"));
  EXPECT_FALSE(mine.still_names("a", file->get())) << "the file name now refers to another file";
}

TEST_F(RuntimeFolderTest, OnlyFoldersInRunEndWithTheMachine) {
  EXPECT_FALSE(folder().ends_with_the_machine());
}

}  // namespace
}  // namespace softgrip::daemon::runtime_folder_test
