#include "daemon/service/runtime_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "tests/support/files.h"

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

  ScratchFolder parent_;
  std::string place_;
};

TEST_F(RuntimeFolderTest, CreatedFilesAreAccessibleOnlyToTheOwner) {
  const RuntimeFolder mine = folder();
  EXPECT_EQ(mine.path(), place_);
  EXPECT_EQ(mode_of(place_), 0700U);
  ASSERT_TRUE(mine.lock_file("a.lock"));
  ASSERT_TRUE(mine.put("b.json", "text"));
  EXPECT_EQ(mode_of(place_ + "/a.lock"), 0600U);
  EXPECT_EQ(mode_of(place_ + "/b.json"), 0600U);
}

TEST_F(RuntimeFolderTest, AFolderWritableByOthersIsSkipped) {
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

TEST_F(RuntimeFolderTest, AFolderOfAnotherUserIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can change the owner of a folder";
  fs::create_directory(place_);
  ASSERT_EQ(::chown(place_.c_str(), 65534, 65534), 0);
  const auto opened = RuntimeFolder::open({place_});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().find("belongs to user 65534"), std::string::npos) << opened.error();
}

TEST_F(RuntimeFolderTest, ASymbolicLinkIsRefusedAsAFolder) {
  fs::create_directory(parent_.path() + "/elsewhere");
  fs::create_directory_symlink(parent_.path() + "/elsewhere", place_);
  EXPECT_FALSE(RuntimeFolder::open({place_}));
}

TEST_F(RuntimeFolderTest, UnsafeFilesAreRefusedAndLinkTargetsKept) {
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

TEST_F(RuntimeFolderTest, PutReplacesTheFileAndLeavesNoTemporaryFile) {
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

TEST_F(RuntimeFolderTest, StillNamesDetectsARemovedOrReplacedFile) {
  const RuntimeFolder mine = folder();
  const auto file = mine.lock_file("a");
  ASSERT_TRUE(file) << file.error();
  EXPECT_TRUE(mine.still_names("a", file->get()));
  mine.remove("a");
  EXPECT_FALSE(mine.still_names("a", file->get()));
  ASSERT_TRUE(mine.lock_file("a"));
  EXPECT_FALSE(mine.still_names("a", file->get())) << "the file name now refers to another file";
}

TEST_F(RuntimeFolderTest, AFolderOutsideRunDoesNotEndWithTheMachine) {
  EXPECT_FALSE(folder().ends_with_the_machine());
}

namespace fs = std::filesystem;

class KeptRig : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto place = RuntimeFolder::open();
    if (!place || !place->ends_with_the_machine()) GTEST_SKIP() << "this user has no folder in /run";
    fs::copy(SOFTGRIP_SOURCE_DIR "/config", folder_.path() + "/config", fs::copy_options::recursive);
  }
  ~KeptRig() override { forget_rig(path_); }

  [[nodiscard]] rig::RigFile load(const std::string& path) const {
    document::Problems problems;
    auto rig = rig::load_rig(path, problems);
    EXPECT_TRUE(rig) << problems.format();
    return std::move(*rig);
  }
  /// Removes the second half of the file, as if an editor were still writing the file.
  void halve(const std::string& file) const {
    const std::string path = folder_.path() + "/config/" + file;
    fs::resize_file(path, fs::file_size(path) / 2);
  }

  ScratchFolder folder_;
  std::string path_ = folder_.path() + "/config/rig_tcp.yaml";
};

TEST_F(KeptRig, EqualsTheRunRigAfterTheFilesAreDamaged) {
  const rig::RigFile rig = load(path_);
  const auto kept = keep_rig(rig);
  ASSERT_TRUE(kept) << kept.error();
  for (const char* file : {"rig_tcp.yaml", "boards/adam-6024.yaml", "models/bench_twin.yaml"}) halve(file);
  document::Problems problems;
  ASSERT_FALSE(rig::load_rig(path_, problems)) << "files that are cut in half are invalid";
  const auto again = kept_rig(path_);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->name, rig.name);
  EXPECT_EQ(again->path, rig.path);
  EXPECT_EQ(again->socket.path, rig.socket.path);
  const auto& board = std::get<drivers::ModbusSettings>(again->board);
  const auto& then = std::get<drivers::ModbusSettings>(rig.board);
  EXPECT_EQ(std::get<drivers::TcpAddress>(board.links.at(0)).host,
            std::get<drivers::TcpAddress>(then.links.at(0)).host);
  EXPECT_EQ(std::get<drivers::TcpAddress>(board.links.at(0)).port,
            std::get<drivers::TcpAddress>(then.links.at(0)).port);
  EXPECT_EQ(board.modules.at(0).map.outputs.registers.count, then.modules.at(0).map.outputs.registers.count);
  ASSERT_EQ(again->inputs.size(), rig.inputs.size());
  for (std::size_t i = 0; i < rig.inputs.size(); ++i) EXPECT_EQ(again->inputs[i].text, rig.inputs[i].text);
}

TEST_F(KeptRig, TheLastRunReplacesTheKeptRig) {
  ASSERT_TRUE(keep_rig(load(path_)));
  std::string text = test::text_of(path_);
  const std::size_t at = text.find("\nname: ");
  ASSERT_NE(at, std::string::npos);
  text.insert(at + 7, "later_");
  std::ofstream(path_) << text;
  ASSERT_TRUE(keep_rig(load(path_)));
  EXPECT_TRUE(kept_rig(path_)->name.starts_with("later_"));
}

TEST_F(KeptRig, IsFoundOnlyByTheSameRigFile) {
  ASSERT_TRUE(keep_rig(load(path_)));
  EXPECT_TRUE(kept_rig(folder_.path() + "/config/../config/./rig_tcp.yaml"))
      << "a different notation of the path refers to the same rig file";
  EXPECT_FALSE(kept_rig(folder_.path() + "/config/rig_rtu.yaml"));
  forget_rig(path_);
  EXPECT_FALSE(kept_rig(path_));
}

TEST_F(KeptRig, ASimulatedRigIsNotKept) {
  const std::string simulated = folder_.path() + "/config/rig.yaml";
  ASSERT_TRUE(keep_rig(load(simulated)));
  EXPECT_FALSE(kept_rig(simulated));
}

TEST_F(KeptRig, ADamagedKeptRigIsNotReturned) {
  ASSERT_TRUE(keep_rig(load(path_)));
  const auto place = RuntimeFolder::open();
  ASSERT_TRUE(place);
  std::string name;
  for (const auto& entry : fs::directory_iterator(place->path())) {
    const std::string text = test::text_of(entry.path());
    if (text.find(path_) != std::string::npos) name = entry.path().filename();
  }
  ASSERT_FALSE(name.empty());
  const std::string whole = test::text_of(place->path() + "/" + name);
  for (const std::string& damaged :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[1, 2]"),
        std::string("{\"schema\": \"x\"}"), std::string("{\"schema\": 2}"), std::string(1000, '\0')}) {
    ASSERT_TRUE(place->put(name, damaged));
    EXPECT_FALSE(kept_rig(path_)) << damaged.substr(0, 20);
  }
  ASSERT_TRUE(place->put(name, whole));
  EXPECT_TRUE(kept_rig(path_));
}

}  // namespace
}  // namespace softgrip::daemon::runtime_folder_test
