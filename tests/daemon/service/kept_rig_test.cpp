#include "daemon/service/kept_rig.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "daemon/service/runtime_folder.h"
#include "tests/daemon/temporary_folder.h"

namespace softgrip::daemon::kept_rig_test {
namespace {

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

  testing::TemporaryFolder folder_;
  std::string path_ = folder_.path() + "/config/rig_tcp.yaml";
};

TEST_F(KeptRig, IsTheRigThatRanWhateverBecameOfTheFiles) {
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

TEST_F(KeptRig, TheLastRunCounts) {
  ASSERT_TRUE(keep_rig(load(path_)));
  std::string text = testing::text_of(path_);
  const std::size_t at = text.find("\nname: ");
  ASSERT_NE(at, std::string::npos);
  text.insert(at + 7, "later_");
  std::ofstream(path_) << text;
  ASSERT_TRUE(keep_rig(load(path_)));
  EXPECT_TRUE(kept_rig(path_)->name.starts_with("later_"));
}

TEST_F(KeptRig, BelongsToItsRigFile) {
  ASSERT_TRUE(keep_rig(load(path_)));
  EXPECT_TRUE(kept_rig(folder_.path() + "/config/../config/./rig_tcp.yaml"))
      << "a different notation of the path refers to the same rig file";
  EXPECT_FALSE(kept_rig(folder_.path() + "/config/rig_rtu.yaml"));
  forget_rig(path_);
  EXPECT_FALSE(kept_rig(path_));
}

TEST_F(KeptRig, NothingIsKeptWhereNoBoardIsDriven) {
  const std::string simulated = folder_.path() + "/config/rig.yaml";
  ASSERT_TRUE(keep_rig(load(simulated)));
  EXPECT_FALSE(kept_rig(simulated));
}

TEST_F(KeptRig, ADamagedOneIsNone) {
  ASSERT_TRUE(keep_rig(load(path_)));
  const auto place = RuntimeFolder::open();
  ASSERT_TRUE(place);
  std::string name;
  for (const auto& entry : fs::directory_iterator(place->path())) {
    const std::string text = testing::text_of(entry.path());
    if (text.find(path_) != std::string::npos) name = entry.path().filename();
  }
  ASSERT_FALSE(name.empty());
  const std::string whole = testing::text_of(place->path() + "/" + name);
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
}  // namespace softgrip::daemon::kept_rig_test
