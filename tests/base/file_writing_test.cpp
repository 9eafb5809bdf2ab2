#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "base/files.h"

// Tests that a failed or interrupted write leaves the old file, or no file if there was none.
namespace softgrip::file_writing_test {
namespace {

namespace fs = std::filesystem;

class FileWritingTest : public testing::Test {
 protected:
  FileWritingTest() { EXPECT_TRUE(create_file(path_, "old")); }
  static std::string text(const fs::path& path) { return read_file(path.string(), 1000).value_or("?"); }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  std::string path_ = (folder_ / "rig.yaml").string();
};

TEST_F(FileWritingTest, CreateRefusesAnExistingFile) {
  const auto again = create_file(path_, "new");
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().find("File exists"), std::string::npos) << again.error();
  EXPECT_EQ(text(path_), "old");
}

TEST_F(FileWritingTest, AReplacedFileKeepsItsPermissions) {
  ASSERT_EQ(::chmod(path_.c_str(), 0640), 0);
  ASSERT_TRUE(replace_file(path_, "new"));
  EXPECT_EQ(text(path_), "new");
  struct ::stat now {};
  ASSERT_EQ(::stat(path_.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0640U);
  EXPECT_EQ(count(), 1U) << "no temporary file remains in the folder";
}

TEST_F(FileWritingTest, ReplacingThroughALinkKeepsTheLink) {
  const fs::path link = folder_ / "link.yaml";
  fs::create_symlink("rig.yaml", link);
  ASSERT_TRUE(replace_file(link.string(), "new"));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text(path_), "new");
}

TEST_F(FileWritingTest, ReplaceRefusesAMissingFile) {
  EXPECT_FALSE(replace_file((folder_ / "absent.yaml").string(), "new"));
  EXPECT_EQ(count(), 1U);
}

TEST_F(FileWritingTest, WriteFileReplacesAFileAndKeepsThePermissions) {
  ASSERT_EQ(::chmod(path_.c_str(), 0640), 0);
  ASSERT_TRUE(write_file(path_, "new"));
  ASSERT_TRUE(write_file((folder_ / "deep/er/new.csv").string(), "first", Sync::none));
  EXPECT_EQ(text(path_), "new");
  EXPECT_EQ(text(folder_ / "deep/er/new.csv"), "first");
  struct ::stat now {};
  ASSERT_EQ(::stat(path_.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0640U);
  EXPECT_EQ(count(), 2U) << "no temporary file remains in the folder";
}

TEST_F(FileWritingTest, ANewFileHasThePermissionsOfTheUmask) {
  const mode_t before = ::umask(027);
  const auto written = write_file((folder_ / "new.csv").string(), "x");
  ::umask(before);
  ASSERT_TRUE(written);
  struct ::stat now {};
  ASSERT_EQ(::stat((folder_ / "new.csv").c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0640U);
}

/// In a shared folder, another user can create a symbolic link with the name of the result file. The link can
/// point to a file of the user who writes the result. This file must not be overwritten.
TEST_F(FileWritingTest, WriteFileReplacesALinkAndDoesNotFollowTheLink) {
  const fs::path link = folder_ / "result.csv";
  fs::create_symlink("rig.yaml", link);
  ASSERT_TRUE(write_file(link.string(), "new"));
  EXPECT_FALSE(fs::is_symlink(link));
  EXPECT_EQ(text(link), "new");
  EXPECT_EQ(text(path_), "old");
  fs::create_symlink("absent", folder_ / "dangling.yaml");
  EXPECT_FALSE(create_file((folder_ / "dangling.yaml").string(), "new"));
  EXPECT_FALSE(fs::exists(folder_ / "absent"));
}

TEST_F(FileWritingTest, APrivateFileHasMode0600AndReplacesALink) {
  fs::create_symlink("rig.yaml", folder_ / "kept.json");
  const Descriptor folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  ASSERT_TRUE(write_private_file(folder, "kept.json", "new"));
  struct ::stat now {};
  ASSERT_EQ(::lstat((folder_ / "kept.json").c_str(), &now), 0);
  EXPECT_TRUE(S_ISREG(now.st_mode));
  EXPECT_EQ(now.st_mode & 07777U, 0600U);
  EXPECT_EQ(text(folder_ / "kept.json"), "new");
  EXPECT_EQ(text(path_), "old");
  EXPECT_EQ(count(), 2U) << "no temporary file remains in the folder";
  EXPECT_FALSE(write_private_file(Descriptor(), "kept.json", "newer"));
}

TEST_F(FileWritingTest, AFolderWithTheNameOfTheFileIsAnError) {
  fs::create_directory(folder_ / "taken");
  const auto written = write_file((folder_ / "taken").string(), "new");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error(), "cannot write " + (folder_ / "taken").string() + ": Is a directory");
  EXPECT_FALSE(write_file((fs::path(path_) / "below").string(), "new"));
  EXPECT_EQ(count(), 2U);
}

/// Limits the file size to 1000 bytes, so that a larger write fails as it does on a full disk.
class SmallFiles {
 public:
  explicit SmallFiles(void (*handler)(int)) : handler_(std::signal(SIGXFSZ, handler)) {
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before_), 0);
    const rlimit small{1000, before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;
  SmallFiles(SmallFiles&&) = delete;
  SmallFiles& operator=(SmallFiles&&) = delete;
  ~SmallFiles() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(FileWritingTest, AFullDiskLeavesTheOldFile) {
  const std::string large(5000, 'x');
  tl::expected<void, std::string> replaced, written, created;
  {
    const SmallFiles disk(SIG_IGN);
    replaced = replace_file(path_, large);
    written = write_file(path_, large, Sync::none);
    created = create_file((folder_ / "other.yaml").string(), large);
  }
  ASSERT_FALSE(replaced);
  EXPECT_EQ(replaced.error(), "cannot write " + path_ + ": File too large");
  EXPECT_FALSE(written);
  EXPECT_FALSE(created);
  EXPECT_EQ(text(path_), "old");
  EXPECT_EQ(count(), 1U) << "a failed write leaves no part of the new file";
}

TEST_F(FileWritingTest, AProcessThatIsKilledWhileItWritesLeavesTheOldFile) {
  const pid_t child = ::fork();
  if (child == 0) {
    const SmallFiles killed(SIG_DFL);
    (void)write_file(path_, std::string(5000, 'x'));
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGXFSZ);
  EXPECT_EQ(text(path_), "old");
}

}  // namespace
}  // namespace softgrip::file_writing_test
