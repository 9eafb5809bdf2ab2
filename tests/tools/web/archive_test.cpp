#include "tools/web/archive.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files.h"

namespace softgrip::web::archive_test {
namespace {

namespace fs = std::filesystem;

class ArchiveTest : public ::testing::Test {
 protected:
  ArchiveTest() {
    fs::create_directories(folder_ / "one");
    std::ofstream(folder_ / "one" / "run.csv") << contents_;
  }

  std::shared_ptr<const DiskTask> done(DiskRequest disk_request) {
    auto task = archive_.submit(std::move(disk_request));
    wait_for(*task);
    return task;
  }
  void wait_for(const DiskTask& task) {
    pollfd watched{archive_.descriptor(), POLLIN, 0};
    while (!task.done()) {
      ASSERT_EQ(::poll(&watched, 1, 30'000), 1) << "the archive has not signalled an answer";
      archive_.clear_event();
    }
  }

  std::string contents_ =
      std::string(Archive::chunk_size, 'a') + std::string(Archive::chunk_size, 'b') + "end";
  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  Archive archive_{folder_};
};

TEST_F(ArchiveTest, ListsOpensAndReadsRecordings) {
  EXPECT_EQ(done({.kind = DiskRequest::Kind::listing})->text(),
            R"({"recordings":[{"name":"one","files":["run.csv"]}]})");
  const auto file = done({.kind = DiskRequest::Kind::file, .recording = "one", .name = "run.csv"})->file();
  ASSERT_TRUE(file);
  EXPECT_EQ(file->size, contents_.size());
  std::string bytes;
  for (int chunks = 0; chunks < 3; ++chunks) {
    const auto chunk = done({.kind = DiskRequest::Kind::chunk, .from = file});
    EXPECT_LE(chunk->text().size(), Archive::chunk_size);
    bytes += chunk->text();
  }
  EXPECT_EQ(bytes, contents_);
  EXPECT_TRUE(done({.kind = DiskRequest::Kind::chunk, .from = file})->text().empty());
  EXPECT_FALSE(done({.kind = DiskRequest::Kind::file, .recording = "one", .name = "none.csv"})->file());
}

TEST_F(ArchiveTest, ReturnsTheLastHealthResult) {
  EXPECT_TRUE(done({.kind = DiskRequest::Kind::health})->health().is_null());
  fs::create_directories(folder_ / "health");
  std::ofstream(folder_ / "health" / "health.json") << R"({"made_unix_s": 7, "fingers": []})";
  EXPECT_EQ(done({.kind = DiskRequest::Kind::health})->health()["made_unix_s"], 7);
}

TEST_F(ArchiveTest, AListIsNotOlderThanTheRequest) {
  for (int i = 0; i < 5; ++i) {
    const std::string name = "new-" + std::to_string(i);
    fs::create_directories(folder_ / name);
    std::ofstream(folder_ / name / "run.csv") << "x";
    EXPECT_NE(done({.kind = DiskRequest::Kind::listing})->text().find(name), std::string::npos);
  }
}

TEST_F(ArchiveTest, SimultaneousRequestsShareOneList) {
  std::vector<std::shared_ptr<const DiskTask>> tasks;
  for (int i = 0; i < 1000; ++i) tasks.push_back(archive_.submit({.kind = DiskRequest::Kind::listing}));
  std::size_t lists = 0;
  const std::string* last = nullptr;
  for (const auto& task : tasks) {
    wait_for(*task);
    if (&task->text() != last) ++lists;
    last = &task->text();
  }
  EXPECT_LE(lists, 3U) << "each list must be built only once for all clients";
}

TEST_F(ArchiveTest, AbandonedTasksDoNotBlockALaterTask) {
  for (int i = 0; i < 1000; ++i) {
    static_cast<void>(archive_.submit({.kind = DiskRequest::Kind::listing}));
    static_cast<void>(
        archive_.submit({.kind = DiskRequest::Kind::file, .recording = "one", .name = "run.csv"}));
  }
  EXPECT_TRUE(done({.kind = DiskRequest::Kind::file, .recording = "one", .name = "run.csv"})->file());
}

TEST_F(ArchiveTest, EndsWithPendingTasks) {
  std::shared_ptr<const DiskTask> open;
  {
    Archive other(folder_);
    for (int i = 0; i < 100; ++i) open = other.submit({.kind = DiskRequest::Kind::listing});
  }
  EXPECT_EQ(open->request().kind, DiskRequest::Kind::listing)
      << "the task must remain valid, but it may end without an answer";
}

}  // namespace
}  // namespace softgrip::web::archive_test
