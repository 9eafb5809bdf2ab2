#include "sysid/recordings/recording.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/files.h"

namespace softgrip::sysid::recording_test {
namespace {

const std::string csv = "time_s,pressure_command_kpa,displacement_mm\n0,0,0\n0.1,5,1\n0.2,9,2\n";

class RecordingTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(write_file(folder / name, text));
  }
  [[nodiscard]] tl::expected<Recording, std::string> read() const {
    document::Problems problems;
    return read_recording(folder, problems);
  }

  const ScratchFolder scratch;
  std::filesystem::path folder = scratch.path();
};

TEST_F(RecordingTest, InvalidRecordingIsRefused) {
  EXPECT_NE(read().error().find("run.csv"), std::string::npos) << "the error must name run.csv";
  write("run.csv", "hello\n");
  EXPECT_EQ(read().error(), "") << "the list of problems must contain the reason";
}

TEST_F(RecordingTest, NamedPipeIsNotWaitedFor) {
  write("run.csv", csv);
  ASSERT_EQ(::mkfifo((folder / "run.json").c_str(), 0600), 0);
  EXPECT_TRUE(read()) << "a run.json that is a pipe is ignored";
  std::filesystem::remove(folder / "run.csv");
  ASSERT_EQ(::mkfifo((folder / "run.csv").c_str(), 0600), 0);
  const auto recording = read();
  ASSERT_FALSE(recording);
  EXPECT_NE(recording.error().find("run.csv"), std::string::npos) << recording.error();
}

TEST_F(RecordingTest, DataOfRunJsonAreReadWithoutTheLog) {
  write("run.csv", "hello\n");
  write("run.json", R"({"software_version": "1", "started_at": "2026-11-30T07:00:00Z", "state": "recording",
                        "sequence": {"name": "pick", "sha256": "0123456789"}})");
  const Recording data = read_recording_data(folder);
  EXPECT_EQ(data.name, folder.filename());
  EXPECT_EQ(data.started_at, "2026-11-30T07:00:00Z");
  EXPECT_EQ(data.recipe, "pick 01234567");
  EXPECT_TRUE(data.unfinished);
  EXPECT_TRUE(data.channels.empty());
  EXPECT_EQ(read_recording_data(folder / "run.csv").started_at, "");
}

}  // namespace
}  // namespace softgrip::sysid::recording_test
