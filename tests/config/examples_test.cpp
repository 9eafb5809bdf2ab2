// Tests that the check accepts the shipped configurations without a warning. Also tests that these
// configurations are consistent with each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/files.h"
#include "rig/check.h"
#include "tests/support/files.h"

namespace softgrip::daemon::examples_test {
namespace {

std::vector<std::string> shipped() {
  std::vector<std::string> paths;
  const std::filesystem::path config = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "config";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(config)) {
    // The sequence in config/vacuum needs a vacuum. The rigs outside config/vacuum refuse this sequence,
    // because they have no vacuum.
    const bool vacuum = entry.path().string().find("/config/vacuum/") != std::string::npos;
    if (!vacuum && entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
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

TEST(Examples, VacuumRigExamplesAreAccepted) {
  const rig::CheckReport report =
      rig::check_files(std::vector<std::string>{std::string(SOFTGRIP_SOURCE_DIR) + "/config/vacuum"});
  EXPECT_TRUE(report.accepted());
  EXPECT_EQ(report.problems.format(), "");
  EXPECT_EQ(report.files.size(), 4U);
  EXPECT_TRUE(report.has_rig);
}

TEST(Examples, IncludeAtLeastTwoFilesOfEachKind) {
  const rig::CheckReport report = rig::check_files(shipped());
  for (const rig::FileKind kind :
       {rig::FileKind::rig, rig::FileKind::board_map, rig::FileKind::model, rig::FileKind::sequence}) {
    const auto of_kind = [&](const rig::CheckedFile& file) { return file.kind == kind; };
    EXPECT_GE(std::count_if(report.files.begin(), report.files.end(), of_kind), 2) << name_of(kind);
  }
}

/// Collects the keys of `node` and of all nodes below it. Omits the channel names, because the author of the
/// file chooses them.
void collect_keys(const document::Node& node, std::set<std::string>& keys) {
  for (const document::Node::Entry& entry : node.entries) {
    if (entry.key != "left" && entry.key != "right") keys.insert(entry.key);
    collect_keys(entry.value, keys);
  }
  for (const document::Node& item : node.items) collect_keys(item, keys);
}

TEST(Examples, UseOnlyKeysThatTheManualDescribes) {
  const std::string root = SOFTGRIP_SOURCE_DIR;
  const std::string manual = test::text_of(root + "/docs/reference/rig-file.md");
  std::set<std::string> keys;
  document::Problems problems;
  for (const char* const name : {"rig.yaml", "rig_tcp.yaml", "rig_rtu.yaml", "rig_iio.yaml",
                                 "rig_service.yaml", "rig_planned.yaml", "vacuum/rig.yaml"}) {
    collect_keys(document::parse_file(root + "/config/" + name, problems).root, keys);
  }
  EXPECT_GE(keys.size(), 70U);
  for (const std::string& key : keys) EXPECT_NE(manual.find(key + "`"), std::string::npos) << key;
}

TEST(Check, AFileGivenTwiceIsReadOnce) {
  const std::string path = std::string(SOFTGRIP_SOURCE_DIR) + "/config/rig.yaml";
  EXPECT_EQ(rig::check_files(std::vector<std::string>{path, path}).files.size(), 1U);
}

TEST(Check, CountsErrorsSeparatelyForEachFile) {
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

TEST(Check, AFolderIncludesAllFilesAndEachFileOnce) {
  const std::string boards = std::string(SOFTGRIP_SOURCE_DIR) + "/config/boards";
  const rig::CheckReport report =
      rig::check_files(std::vector<std::string>{boards, boards + "/adam-6024.yaml"});
  EXPECT_TRUE(report.accepted()) << report.problems.format();
  const auto count = std::distance(std::filesystem::directory_iterator(boards), {});
  EXPECT_EQ(report.files.size(), static_cast<std::size_t>(count));
  EXPECT_FALSE(report.has_rig);
}

/// A temporary folder that contains the given files. The destructor removes the folder.
class CheckFolder : public ::testing::Test {
 protected:
  CheckFolder() { std::filesystem::create_directories(folder_ / "sub/.hidden"); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  using Changes = std::vector<std::pair<std::string, std::string>>;
  /// Replaces the given texts in a copy of the shipped simulated rig and writes the copy to a file.
  void write_rig(Changes changes) {
    std::string text = test::text_of(config_ / "rig.yaml");
    changes.emplace_back("models/", (config_ / "models/").string());
    for (const auto& [old, now] : changes) {
      ASSERT_NE(text.find(old), std::string::npos) << old;
      for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + now.size()))
        text.replace(at, old.size(), now);
    }
    write("rig.yaml", text);
  }
  rig::CheckReport check() { return rig::check_files(std::vector<std::string>{folder_.string()}); }
  static bool says(const rig::CheckReport& report, const std::string& words) {
    return report.problems.format().find(words) != std::string::npos;
  }
  std::filesystem::path config_ = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "config";
  const ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
};

TEST_F(CheckFolder, FilesOfUnknownKindAreSkipped) {
  write("sub/model.yaml", "name: m\nsource: s\nactuator: []\n");
  write("compose.yaml", "version: 3\n");
  write("notes.txt", "name: [\n");
  write("sub/.hidden/rig.yaml", "name: [\n");
  const rig::CheckReport report = check();
  ASSERT_EQ(report.files.size(), 2U);
  EXPECT_TRUE(report.files[0].passed_over);
  EXPECT_FALSE(report.files[1].passed_over);
  EXPECT_FALSE(says(report, "not a rig, a board map"));
}

TEST_F(CheckFolder, AFolderWithoutReadableFilesIsAProblem) {
  EXPECT_TRUE(says(check(), "contain no readable *.yaml"));
}

TEST_F(CheckFolder, SequencesAreCheckedAgainstARigWithOtherErrors) {
  write_rig({{"mode: \"0660\"", "mode: \"9999\""}});
  write("far.yaml",
        "name: far\nchannels: [left, middle]\nsteps:\n  - move: {displacement_mm: 90, duration_s: 1}\n");
  const rig::CheckReport report = check();
  EXPECT_TRUE(says(report, "`mode` must state the permissions of the socket, found `9999`"))
      << report.problems.format();
  EXPECT_TRUE(says(report, "the rig has no channel 'middle'")) << report.problems.format();
  EXPECT_TRUE(says(report, "goes to 90 mm")) << report.problems.format();
}

TEST_F(CheckFolder, SequencesAreCheckedAgainstTheReadableChannels) {
  write_rig({{"  - name: left\n", "  - name: left\n    limits: {pressure_max_kpa: high}\n"}});
  write("far.yaml",
        "name: far\nsteps:\n"
        "  - move: {channels: [left], displacement_mm: 90, duration_s: 1}\n"
        "  - move: {channels: [right], displacement_mm: 80, duration_s: 1}\n");
  const rig::CheckReport report = check();
  EXPECT_TRUE(says(report, "`pressure_max_kpa` must be a number")) << report.problems.format();
  EXPECT_FALSE(says(report, "goes to 90 mm"))
      << "the limits of channel left are invalid, so its motions cannot be checked";
  EXPECT_TRUE(says(report, "goes to 80 mm, channel 'right'")) << report.problems.format();
}

TEST_F(CheckFolder, CrossChecksAreReportedTogetherWithOtherErrors) {
  write_rig({{"watchdog_timeout_s: 0.5", "watchdog_timeout_s: 0.02"}, {"mode: \"0660\"", "mode: \"9999\""}});
  const rig::CheckReport report = check();
  EXPECT_TRUE(says(report, "`mode` must state the permissions of the socket, found `9999`"))
      << report.problems.format();
  EXPECT_TRUE(says(report, "`bus_down_cycles` correspond to")) << report.problems.format();
}

}  // namespace
}  // namespace softgrip::daemon::examples_test
