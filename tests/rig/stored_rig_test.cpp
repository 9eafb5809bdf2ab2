#include "rig/rig_file.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace softgrip::rig::stored_rig_test {
namespace {

RigFile shipped(const std::string& name) {
  document::Problems problems;
  auto rig = load_rig(std::string(SOFTGRIP_SOURCE_DIR "/config/") + name, problems);
  EXPECT_TRUE(rig) << problems.format();
  return rig ? std::move(*rig) : RigFile{};
}

/// Copies the files. In the copy, replaces the path of each file by a path that does not exist.
std::vector<InputFile> elsewhere(std::vector<InputFile> files) {
  const std::string from = SOFTGRIP_SOURCE_DIR "/config";
  for (InputFile& file : files) {
    EXPECT_TRUE(file.path.starts_with(from)) << file.path;
    file.path.replace(0, from.size(), "/nowhere");
  }
  return files;
}

TEST(StoredRig, IsReadWithoutTheFilesOnDisk) {
  for (const char* name : {"rig_tcp.yaml", "rig_rtu.yaml", "rig_iio.yaml", "rig_service.yaml", "rig.yaml"}) {
    const RigFile rig = shipped(name);
    document::Problems problems;
    const auto again = read_stored_rig(elsewhere(rig.inputs), problems);
    ASSERT_TRUE(again) << name << "\n" << problems.format();
    EXPECT_EQ(again->path, std::string("/nowhere/") + name);
    EXPECT_EQ(again->settings.channels.size(), rig.settings.channels.size());
    EXPECT_EQ(again->settings.channels[0].limits.pressure_min_kpa,
              rig.settings.channels[0].limits.pressure_min_kpa);
    EXPECT_EQ(again->board.index(), rig.board.index());
    EXPECT_EQ(again->inputs.size(), rig.inputs.size());
  }
}

TEST(StoredRig, AnUnstoredFileIsAProblemEvenIfPresentOnDisk) {
  std::vector<InputFile> files = shipped("rig_tcp.yaml").inputs;
  ASSERT_GT(files.size(), 1U);
  ASSERT_TRUE(std::filesystem::exists(files.back().path));
  files.pop_back();
  document::Problems problems;
  EXPECT_FALSE(read_stored_rig(files, problems));
  EXPECT_FALSE(problems.empty());
}

TEST(StoredRig, ADamagedFileIsAProblem) {
  std::vector<InputFile> files = shipped("rig_tcp.yaml").inputs;
  files.front().text.resize(files.front().text.size() / 2);
  document::Problems problems;
  EXPECT_FALSE(read_stored_rig(files, problems));
  EXPECT_FALSE(problems.empty());
  EXPECT_FALSE(read_stored_rig({}, problems)) << "a stored rig that contains no files is refused";
}

}  // namespace
}  // namespace softgrip::rig::stored_rig_test
