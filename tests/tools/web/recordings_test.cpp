#include "tools/web/recordings.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/files.h"

namespace softgrip::web::recordings_test {
namespace {

namespace fs = std::filesystem;

class RecordingsTest : public ::testing::Test {
 protected:
  void add(const std::string& recording, const std::string& file) const {
    fs::create_directories(folder_ / recording);
    std::ofstream(folder_ / recording / file) << file;
  }
  /// Returns the list of recordings for a time one minute from now. At that time, the time stamp of a folder
  /// is so old that a further change would give the folder a different time stamp.
  std::string list() { return recordings_.list(wall_time_now() + 60 * ns_per_s).dump(); }

  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  Recordings recordings_{folder_};
};

TEST_F(RecordingsTest, ListsTheNewestFirstWithTheirViewableFiles) {
  EXPECT_EQ(list(), "[]");
  add("2026-01-01", "run.csv");
  add("2026-01-02", "run.csv");
  add("2026-01-02", "a.svg");
  add("2026-01-02", "run.mcap");
  add("2026-01-03", "run.mcap");
  std::ofstream(folder_ / "a.csv") << "no folder";
  EXPECT_EQ(
      list(),
      R"([{"name":"2026-01-02","files":["a.svg","run.csv"]},{"name":"2026-01-01","files":["run.csv"]}])");
}

TEST_F(RecordingsTest, ListsNothingWithoutAFolder) {
  EXPECT_EQ(Recordings({}).list(0).dump(), "[]");
  EXPECT_EQ(Recordings(folder_ / "nowhere").list(0).dump(), "[]");
  add("one", "run.csv");
  EXPECT_NE(list(), "[]");
  fs::remove_all(folder_);
  EXPECT_EQ(list(), "[]");
}

TEST_F(RecordingsTest, ReadsOnlyChangedFolders) {
  for (int i = 0; i < 300; ++i) add("run-" + std::to_string(1000 + i), i % 2 == 0 ? "run.csv" : "run.mcap");
  const std::string first = list();
  EXPECT_EQ(recordings_.folders_read(), 1U + 300U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(list(), first);
  EXPECT_EQ(recordings_.folders_read(), 301U)
      << "folders without a file that can be shown must also be read only once";

  add("run-1299", "late.svg");
  EXPECT_NE(list().find(R"({"name":"run-1299","files":["late.svg"]})"), std::string::npos);
  EXPECT_EQ(recordings_.folders_read(), 302U);
  add("run-2000", "run.csv");
  EXPECT_TRUE(list().starts_with(R"([{"name":"run-2000","files":["run.csv"]})"));
  EXPECT_EQ(recordings_.folders_read(), 304U) << "only the root folder and the new folder are read";
  fs::remove_all(folder_ / "run-2000");
  EXPECT_EQ(list().find("run-2000"), std::string::npos);
}

TEST_F(RecordingsTest, AFolderThatWasReplacedIsReadAgain) {
  add("one", "old.csv");
  EXPECT_NE(list().find("old.csv"), std::string::npos);
  add("two", "new.csv");
  fs::rename(folder_ / "one", folder_ / ".aside");
  fs::rename(folder_ / "two", folder_ / "one");
  EXPECT_EQ(list(), R"([{"name":"one","files":["new.csv"]}])");
}

TEST_F(RecordingsTest, AFolderThatHasJustChangedIsReadAgain) {
  add("one", "run.csv");
  struct stat about {};
  ASSERT_EQ(::stat((folder_ / "one").c_str(), &about), 0);
  const Nanoseconds changed = about.st_ctim.tv_sec * ns_per_s + about.st_ctim.tv_nsec;
  static_cast<void>(recordings_.list(changed));
  const std::size_t read = recordings_.folders_read();
  static_cast<void>(recordings_.list(changed - 100 * ns_per_s));
  EXPECT_EQ(recordings_.folders_read(), 2 * read)
      << "the time stamp of the folder is too coarse to exclude a second change";
}

TEST_F(RecordingsTest, ConsidersOnlyTheNewestFolders) {
  for (std::size_t i = 0; i < 2 * Recordings::most_considered + 10; ++i)
    fs::create_directory(folder_ / ("run-" + std::to_string(100'000 + i)));
  add("run-0", "run.csv");
  EXPECT_EQ(list(), "[]") << "run-0 is not one of the newest folders, and only these are read";
  EXPECT_EQ(recordings_.folders_read(), 1 + Recordings::most_considered);
  add("run-999999", "run.csv");
  EXPECT_EQ(list(), R"([{"name":"run-999999","files":["run.csv"]}])");
  EXPECT_EQ(recordings_.folders_read(), 1 + Recordings::most_considered + 2);
}

TEST_F(RecordingsTest, LimitsTheNumberOfRecordingsAndFiles) {
  for (std::size_t i = 0; i < Recordings::most_listed + 50; ++i)
    add("run-" + std::to_string(1000 + i), "run.csv");
  for (int i = 0; i < 300; ++i) add("run-9999", std::to_string(1000 + i) + ".csv");
  const auto list = recordings_.list(wall_time_now());
  EXPECT_EQ(list.size(), Recordings::most_listed);
  EXPECT_EQ(list[0]["files"].size(), 50U);
  EXPECT_EQ(list[0]["files"][0], "1000.csv");
}

TEST_F(RecordingsTest, CallsTheGivenFunctionBetweenFolders) {
  for (int i = 0; i < 20; ++i) add("run-" + std::to_string(i), "run.csv");
  int turns = 0;
  static_cast<void>(recordings_.list(0, [&turns] { ++turns; }));
  EXPECT_GE(turns, 20);
}

TEST_F(RecordingsTest, OnlyRegularFilesOfARealFolderAreOpened) {
  add("one", "run.csv");
  fs::create_directory_symlink(folder_ / "one", folder_ / "link");
  fs::create_symlink(folder_ / "one" / "run.csv", folder_ / "one" / "link.csv");
  ASSERT_EQ(::mkfifo((folder_ / "one" / "pipe.csv").c_str(), 0600), 0);
  const auto opened = recordings_.open("one", "run.csv");
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->size, 7U);
  for (const char* file : {"link.csv", "pipe.csv", "none.csv", "run.mcap", "../run.csv"})
    EXPECT_FALSE(recordings_.open("one", file)) << file;
  EXPECT_FALSE(recordings_.open("link", "run.csv"));
  EXPECT_FALSE(recordings_.open("..", "run.csv"));
  fs::resize_file(folder_ / "one" / "run.csv", Recordings::largest_file + 1);
  EXPECT_FALSE(recordings_.open("one", "run.csv"));
}

}  // namespace
}  // namespace softgrip::web::recordings_test
