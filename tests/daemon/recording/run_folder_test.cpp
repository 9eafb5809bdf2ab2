#include "daemon/recording/run_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "tests/support/files.h"

namespace softgrip::daemon::run_folder_test {
namespace {

using test::text_of;

/// Limits the size of every file to `bytes`, so that a larger write fails as it does on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  SmallDisk(SmallDisk&&) = delete;
  SmallDisk& operator=(SmallDisk&&) = delete;
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(RunFolder, CreatesTheFolderAndTheHeaderLine) {
  const ScratchFolder temporary;
  const auto folder = RunFolder::create(temporary.path() + "/a/b", "time_s\n", true);
  ASSERT_TRUE(folder) << folder.error();
  EXPECT_EQ(text_of(temporary.path() + "/a/b/run.csv"), "time_s\n");
}

TEST(RunFolder, NeverOverwritesARecording) {
  const ScratchFolder temporary;
  ASSERT_TRUE(RunFolder::create(temporary.path(), "first\n", true));
  const auto second = RunFolder::create(temporary.path(), "second\n", true);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find("never overwritten"), std::string::npos);
  EXPECT_EQ(text_of(temporary.path() + "/run.csv"), "first\n");
}

TEST(RunFolder, AFailedCreationNamesThePath) {
  const auto folder = RunFolder::create("/proc/softgrip", "time_s\n", true);
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().find("/proc/softgrip"), std::string::npos);
}

TEST(RunFolder, AFolderThatCannotBeUsedIsFoundBeforeTheRun) {
  const ScratchFolder temporary;
  const std::string file = temporary.path() + "/file";
  std::ofstream(file) << "mine";
  std::filesystem::create_symlink(temporary.path() + "/nowhere", temporary.path() + "/dangling");
  for (const std::string& path : {file, file + "/a", file + "/a/b", temporary.path() + "/dangling",
                                  std::string("/proc/softgrip"), std::string("/proc/softgrip/a")}) {
    const std::string why = why_unrecordable(path);
    EXPECT_NE(why.find("nothing can be recorded in " + path + ": "), std::string::npos) << path << why;
    EXPECT_FALSE(RunFolder::create(path, "time_s\n", true)) << path;
  }
  EXPECT_EQ(text_of(file), "mine");
}

TEST(RunFolder, TheCheckOfAUsableFolderLeavesNoFolder) {
  const ScratchFolder temporary;
  for (const char* path : {"", "/", "/new", "/new/", "/new/inner", "/new/inner/"})
    EXPECT_EQ(why_unrecordable(temporary.path() + path), "") << path;
  EXPECT_EQ(why_unrecordable(""), "");
  EXPECT_EQ(why_unrecordable("."), "");
  EXPECT_EQ(why_unrecordable("softgrip-new-folder"), "");
  EXPECT_FALSE(std::filesystem::exists("softgrip-new-folder"));
  EXPECT_EQ(files_in(temporary.path()), 0U);
}

TEST(RunFolder, AFullDiskLeavesWholeLinesAndAPermanentError) {
  const ScratchFolder temporary;
  auto folder = RunFolder::create(temporary.path(), "header\n", true);
  ASSERT_TRUE(folder);
  ASSERT_TRUE(folder->append("0,1\n"));
  {
    const SmallDisk disk(14);
    EXPECT_FALSE(folder->append("1,2\n2,3\n3,4\n"));
  }
  EXPECT_FALSE(folder->healthy());
  EXPECT_NE(folder->error().find("File too large"), std::string::npos) << folder->error();
  EXPECT_EQ(text_of(temporary.path() + "/run.csv"), "header\n0,1\n");
  EXPECT_FALSE(folder->append("4,5\n"));
  EXPECT_TRUE(folder->replace_json("{}"));
}

TEST(RunFolder, AFailedCreationLeavesNoEmptyFolder) {
  const ScratchFolder temporary;
  {
    const SmallDisk disk(3);
    EXPECT_FALSE(RunFolder::create(temporary.path() + "/new", "header\n", true));
    EXPECT_FALSE(RunFolder::create(temporary.path(), "header\n", true));
  }
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
}

TEST(RunFolder, ReservesRoomThatTheEndReleases) {
  const ScratchFolder temporary;
  const auto used_bytes = [&] {
    struct stat file {};
    EXPECT_EQ(::stat((temporary.path() + "/run.csv").c_str(), &file), 0);
    return std::size_t{512} * static_cast<std::size_t>(file.st_blocks);
  };
  auto folder = RunFolder::create(temporary.path(), "header\n", true);
  ASSERT_TRUE(folder);
  if (used_bytes() < RunFolder::least_room) GTEST_SKIP() << "this file system cannot reserve space";
  ASSERT_TRUE(folder->append("0,1\n", 1'000'000));
  EXPECT_GE(used_bytes(), 1'000'000U);
  EXPECT_EQ(text_of(temporary.path() + "/run.csv"), "header\n0,1\n");
  folder->release_room();
  EXPECT_LE(used_bytes(), 65'536U);
  EXPECT_EQ(text_of(temporary.path() + "/run.csv"), "header\n0,1\n");
}

TEST(RunFolder, SymbolicLinksAreNeverFollowedOnWriting) {
  namespace fs = std::filesystem;
  const ScratchFolder temporary;
  const std::string victim = temporary.path() + "/victim";
  std::ofstream(victim) << "mine";
  const std::string path = temporary.path() + "/run";
  fs::create_directory(path);
  fs::create_symlink(victim, path + "/run.csv");
  EXPECT_FALSE(RunFolder::create(path, "header\n", true));
  fs::remove(path + "/run.csv");
  auto folder = RunFolder::create(path, "header\n", true);
  ASSERT_TRUE(folder) << folder.error();
  fs::create_symlink(victim, path + "/run.json");
  EXPECT_TRUE(folder->replace_json("{}")) << folder->error();
  EXPECT_FALSE(fs::is_symlink(path + "/run.json"));
  EXPECT_EQ(text_of(path + "/run.json"), "{}");
  EXPECT_EQ(files_in(path), 2U);
  EXPECT_EQ(text_of(victim), "mine");
}

TEST(RunFolder, AFailedReplacementKeepsTheOldRunJson) {
  const ScratchFolder temporary;
  auto folder = RunFolder::create(temporary.path(), "header\n", true);
  ASSERT_TRUE(folder);
  ASSERT_TRUE(folder->replace_json("{\"a\":1}"));
  {
    const SmallDisk disk(8);
    EXPECT_FALSE(folder->replace_json("{\"a\":1,\"b\":2}"));
  }
  EXPECT_EQ(text_of(temporary.path() + "/run.json"), "{\"a\":1}");
  EXPECT_EQ(files_in(temporary.path()), 2U) << "a failed write leaves no incomplete file";
  EXPECT_TRUE(folder->healthy());
  EXPECT_TRUE(folder->error().empty()) << folder->error();
  EXPECT_NE(folder->json_error().find("File too large"), std::string::npos) << folder->json_error();
  EXPECT_TRUE(folder->replace_json("{}"));
  EXPECT_EQ(folder->json_error(), "");
}

}  // namespace
}  // namespace softgrip::daemon::run_folder_test
