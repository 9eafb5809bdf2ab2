#include "base/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <csignal>
#include <filesystem>
#include <fstream>

namespace softgrip::files_test {
namespace {

namespace fs = std::filesystem;

class FilesTest : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return scratch_.path() + "/" + name; }
  /// Writes `text` to a new file and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(at(name)) << text;
    return at(name);
  }

  ScratchFolder scratch_;
};

TEST_F(FilesTest, AFileUpToTheBoundIsRead) {
  EXPECT_EQ(*read_file(file("file", "12345"), 5), "12345");
  const auto larger = read_file(at("file"), 4);
  ASSERT_FALSE(larger);
  EXPECT_EQ(larger.error(), at("file") + " is larger than 4 bytes");
  EXPECT_EQ(*read_file(file("empty", ""), 0), "");
  EXPECT_FALSE(read_file(at("absent"), 5));
}

TEST_F(FilesTest, AFileOfUnknownSizeIsReadUpToTheSizeLimit) {
  EXPECT_GT(read_file("/proc/self/status", 100'000)->size(), 100U);
  EXPECT_FALSE(read_file("/proc/self/status", 100));
}

/// A named pipe must be refused. If the function waited for a process that writes to the pipe, this test
/// would never end.
TEST_F(FilesTest, APipeIsRefusedWithoutWaiting) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  const auto text = read_file(at("pipe"), 100);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error(), "cannot open " + at("pipe") + ": it is a pipe, not a regular file");
  fs::create_symlink("pipe", at("link"));
  EXPECT_FALSE(open_regular(at("link")));
}

TEST_F(FilesTest, DevicesSocketsAndFoldersAreRefused) {
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  ::sockaddr_un address{AF_UNIX, {}};
  at("socket").copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket.get(), reinterpret_cast<const ::sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(open_regular(at("socket")).error(), "it is a socket, not a regular file");
  EXPECT_EQ(open_regular("/dev/zero").error(), "it is a device, not a regular file");
  EXPECT_EQ(open_regular(scratch_.path()).error(), "Is a directory");
}

/// While a process holds a lease on a file (fcntl), every blocking open() of this file waits.
TEST_F(FilesTest, AFileThatAnotherProcessHasLeasedIsRefusedWithoutWaiting) {
  const std::string path = file("leased", "text");
  auto* const before = std::signal(SIGIO, SIG_IGN);
  const Descriptor holder(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (::fcntl(holder.get(), F_SETLEASE, F_WRLCK) != 0)
    GTEST_SKIP() << "this file system does not support leases";
  EXPECT_FALSE(open_regular(path));
  ::fcntl(holder.get(), F_SETLEASE, F_UNLCK);
  std::signal(SIGIO, before);
  EXPECT_TRUE(open_regular(path));
}

TEST_F(FilesTest, OpenRegularInRefusesASymbolicLink) {
  (void)file("file", "text");
  fs::create_symlink("file", at("link"));
  const Descriptor folder(::open(scratch_.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const auto opened = open_regular_in(folder, "file");
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->size, 4U);
  EXPECT_EQ(*read_start(*opened, 3), "tex");
  EXPECT_EQ(*read_start(*opened, 3), "t") << "the second call continues after the bytes of the first call";
  EXPECT_EQ(open_regular_in(folder, "link").error(), "it is a symbolic link, not a regular file");
  EXPECT_TRUE(open_regular(at("link")));
}

TEST(PlainPath, ASeparatorAtTheEndIsRemoved) {
  EXPECT_EQ(plain_path("runs/grip/"), "runs/grip");
  EXPECT_EQ(plain_path("./runs/../runs/grip.csv"), "runs/grip.csv");
  EXPECT_EQ(plain_path("grip"), "grip");
  EXPECT_EQ(plain_path("/"), "/");
  EXPECT_EQ(name_in_path("runs/grip/"), "grip");
  EXPECT_EQ(name_in_path("./runs/../day/grip.csv"), "grip.csv");
}

TEST(WhyUnreadable, StatesTheReasonUnlessThePathIsAFolderOrAFile) {
  const ScratchFolder folder;
  const std::string file = folder.path() + "/file";
  ASSERT_TRUE(write_file(file, "text"));
  EXPECT_EQ(why_unreadable(folder.path()), "");
  EXPECT_EQ(why_unreadable(file), "");
  EXPECT_EQ(why_unreadable(folder.path() + "/none"), "No such file or directory");
  EXPECT_EQ(why_unreadable(file + "/inside"), "Not a directory");
  EXPECT_NE(why_unreadable("/dev/null"), "") << "a device is not a regular file";
}

TEST(ScratchFolder, TheDestructorRemovesTheFolderAndAllFiles) {
  std::string path;
  {
    const ScratchFolder one, other;
    path = one.path();
    ASSERT_FALSE(path.empty());
    EXPECT_NE(path, other.path());
    ASSERT_TRUE(write_file(path + "/deeper/file", "text"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace softgrip::files_test
