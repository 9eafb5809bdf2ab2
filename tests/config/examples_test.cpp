// The configurations that are shipped: accepted without a warning, and fit for each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "rig/check.h"

namespace softgrip::daemon {
namespace {

std::vector<std::string> shipped() {
  std::vector<std::string> paths;
  const std::filesystem::path config = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "config";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(config)) {
    if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST(Examples, AreAccepted) {
  const rig::CheckReport report = rig::check_files(shipped());
  EXPECT_TRUE(report.accepted());
  EXPECT_EQ(report.problems.format(), "");
  for (const rig::CheckedFile& file : report.files) {
    EXPECT_NE(file.kind, rig::FileKind::unknown) << file.path;
    EXPECT_FALSE(file.name.empty()) << file.path;
  }
}

TEST(Examples, OfEveryKindAreThere) {
  const rig::CheckReport report = rig::check_files(shipped());
  for (const rig::FileKind kind :
       {rig::FileKind::rig, rig::FileKind::board_map, rig::FileKind::model, rig::FileKind::sequence}) {
    const auto of_kind = [&](const rig::CheckedFile& file) { return file.kind == kind; };
    EXPECT_GE(std::count_if(report.files.begin(), report.files.end(), of_kind), 2) << name_of(kind);
  }
}

/// All keys below a node, but for those that the file's author chose.
void collect_keys(const document::Node& node, std::set<std::string>& keys) {
  for (const document::Node::Entry& entry : node.entries) {
    if (entry.key != "left" && entry.key != "right") keys.insert(entry.key);
    collect_keys(entry.value, keys);
  }
  for (const document::Node& item : node.items) collect_keys(item, keys);
}

TEST(Examples, UseOnlyKeysThatTheManualDescribes) {
  const std::string root = SOFTGRIP_SOURCE_DIR;
  std::ostringstream manual;
  manual << std::ifstream(root + "/docs/reference/rig-file.md").rdbuf();
  std::set<std::string> keys;
  document::Problems problems;
  for (const char* const name :
       {"rig.yaml", "rig_tcp.yaml", "rig_rtu.yaml", "rig_service.yaml", "rig_planned.yaml"}) {
    collect_keys(document::parse_file(root + "/config/" + name, problems).root, keys);
  }
  EXPECT_GE(keys.size(), 70U);
  for (const std::string& key : keys) EXPECT_NE(manual.str().find(key + "`"), std::string::npos) << key;
}

TEST(Check, AFileGivenTwiceIsReadOnce) {
  const std::string path = std::string(SOFTGRIP_SOURCE_DIR) + "/config/rig.yaml";
  EXPECT_EQ(rig::check_files(std::vector<std::string>{path, path}).files.size(), 1U);
}

TEST(Check, CountsErrorsOfEachFileAlone) {
  const std::string broken = std::string(SOFTGRIP_SOURCE_DIR) + "/tests/config/broken/";
  const rig::CheckReport report =
      rig::check_files(std::vector<std::string>{broken + "files_broken.yaml", broken + "model.yaml"});
  EXPECT_EQ(report.files[0].errors, 0U);
  EXPECT_EQ(report.files[1].errors, 5U);
  EXPECT_FALSE(report.accepted());
}

TEST(Check, AMissingFileIsAProblem) {
  const rig::CheckReport report = rig::check_files(std::vector<std::string>{"/nonexistent.yaml"});
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems.list()[0].message, "the file cannot be read: No such file or directory");
}

}  // namespace
}  // namespace softgrip::daemon
