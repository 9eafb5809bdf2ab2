#include "daemon/recording/recorder.h"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/periodic_schedule.h"
#include "daemon/socket/service.h"
#include "tests/support/files.h"

namespace softgrip::daemon::recorder_test {
namespace {

using control::Event;
using control::State;
using test::text_of;

constexpr Nanoseconds period = 10'000'000;

/// Tests of the recorder. The test passes the data of each tick to the recorder.
class RecorderTest : public ::testing::Test {
 protected:
  RecorderTest() {
    settings_.directory = temporary_.path();
    provenance_.software_version = "test";
    provenance_.rig = "bench";
    provenance_.channel_names = {"left", "right"};
    provenance_.rate_hz = 100;
    provenance_.virtual_time = true;
    provenance_.seed = 42;
    store("pick stone", 7);
  }

  void store(const char* name, std::uint32_t request) {
    auto sequence = std::make_shared<LoadedSequence>();
    sequence->prepared.name = name;
    sequence->sha256 = "00ff";
    sequence_store_.put(request, sequence);
  }

  Recorder& recorder() {
    if (!recorder_) {
      recorder_ =
          std::make_unique<Recorder>(settings_, provenance_, only_folder_, 0, shared_, log_, sequence_store_);
    }
    return *recorder_;
  }

  void event(Event::Kind kind, const Event::Detail& detail = {}, std::uint32_t request = 0) {
    StampedEvent event;
    event.at = now_;
    event.event.kind = kind;
    event.event.detail = detail;
    event.event.request = request;
    shared_.events.push(event);
  }

  void ticks(int count, State state) {
    for (int i = 0; i < count; ++i) {
      tick(state);
      recorder().drain();
    }
  }
  /// Pushes the rows of one tick, which the recorder does not take yet.
  void tick(State state) {
    for (std::uint8_t channel = 0; channel < 2; ++channel) {
      Record record;
      record.at = now_;
      record.state = state;
      record.channel = channel;
      record.output.validity = model::Validity::valid;
      shared_.records.push(record);
    }
    now_ += period;
  }

  /// Returns the sorted names of all run folders.
  std::vector<std::string> folders() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(temporary_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  nlohmann::json json(const std::string& folder) const {
    return nlohmann::json::parse(text_of(temporary_.path() + "/" + folder + "/run.json"));
  }
  std::vector<std::string> lines(const std::string& folder) const {
    std::vector<std::string> result;
    std::istringstream text(text_of(temporary_.path() + "/" + folder + "/run.csv"));
    for (std::string line; std::getline(text, line);) result.push_back(line);
    return result;
  }

  ScratchFolder temporary_;
  rig::RecorderSettings settings_;
  Provenance provenance_;
  std::string only_folder_;
  SharedState shared_{4096};
  EventLog log_{100};
  SequenceStore sequence_store_;
  std::unique_ptr<Recorder> recorder_;
  Nanoseconds now_ = 50 * ns_per_s;
};

TEST_F(RecorderTest, ASequenceIsRecordedUntilHalfASecondAfterTheMotion) {
  ticks(200, State::idle);
  event(Event::Kind::sequence_started, {}, 7);
  ticks(100, State::running);
  ticks(200, State::idle);
  recorder().finish();
  ASSERT_EQ(folders(), std::vector<std::string>{"run-0001_pick_stone"});
  const auto rows = lines(folders().front());
  EXPECT_EQ(rows.size(), 1 + 2 * (100 + 50));
  EXPECT_EQ(rows[1].substr(0, 7), "0,left,");
  const auto story = json(folders().front());
  EXPECT_EQ(story["state"], "complete");
  EXPECT_EQ(story["reason"], "sequence");
  EXPECT_EQ(story["sequence"]["name"], "pick stone");
  EXPECT_EQ(story["sequence"]["request"], 7);
  EXPECT_EQ(story["rows"], 300);
  EXPECT_EQ(story["dropped_rows"], 0);
  EXPECT_EQ(story["seed"], 42);
  EXPECT_FALSE(story.contains("started_at"));
  EXPECT_EQ(story["events"][0]["kind"], "sequence_started");
}

TEST_F(RecorderTest, AFaultRecordingIncludesTheSecondBeforeTheFault) {
  ticks(300, State::idle);
  event(Event::Kind::fault_latched, control::FaultCode::bus_down);
  ticks(200, State::faulted);
  recorder().finish();
  ASSERT_EQ(folders(), std::vector<std::string>{"run-0001_fault"});
  const auto story = json(folders().front());
  EXPECT_EQ(story["reason"], "fault");
  EXPECT_EQ(story["faults"][0]["code"], "F101");
  EXPECT_NEAR(story["faults"][0]["time_s"].get<double>(), 1.0, 0.011);
  EXPECT_EQ(lines(folders().front())[1].substr(0, 7), "0,left,");
}

TEST_F(RecorderTest, AFaultDuringASequenceIsInTheSequenceRecording) {
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  event(Event::Kind::fault_latched, control::FaultCode::reading_jumped);
  ticks(200, State::faulted);
  recorder().finish();
  ASSERT_EQ(folders().size(), 1U);
  EXPECT_EQ(json(folders().front())["faults"][0]["code"], "F204");
}

TEST_F(RecorderTest, AStartShortlyAfterARunGetsASeparateRecording) {
  for (int run = 0; run < 2; ++run) {
    event(Event::Kind::sequence_started, {}, 7);
    ticks(10, State::running);
    ticks(10, State::idle);
  }
  recorder().finish();
  EXPECT_EQ(folders(), (std::vector<std::string>{"run-0001_pick_stone", "run-0002_pick_stone"}));
  EXPECT_EQ(json("run-0001_pick_stone")["rows"], 40);
}

TEST_F(RecorderTest, TwoStartsThatTheServiceTookFirstGetTheirOwnRecordings) {
  store("free stroke", 8);
  Service service(provenance_.channel_names, 0, shared_, log_, sequence_store_);
  event(Event::Kind::sequence_started, {}, 7);
  for (int i = 0; i < 10; ++i) tick(State::running);
  event(Event::Kind::sequence_started, {}, 8);
  for (int i = 0; i < 20; ++i) tick(State::running);
  service.pump();
  recorder().finish();
  ASSERT_EQ(folders(), (std::vector<std::string>{"run-0001_pick_stone", "run-0002_free_stroke"}));
  EXPECT_EQ(json(folders()[0])["sequence"]["request"], 7);
  EXPECT_EQ(json(folders()[0])["rows"], 20);
  EXPECT_EQ(json(folders()[1])["sequence"]["name"], "free stroke");
  EXPECT_EQ(json(folders()[1])["rows"], 40);
  EXPECT_EQ(sequence_store_.find(7), nullptr);
}

TEST_F(RecorderTest, AStartAfterAStartWithoutAStoredSequenceGetsASeparateRecording) {
  for (const std::uint32_t request : {20U, 21U}) {
    event(Event::Kind::sequence_started, {}, request);
    ticks(10, State::running);
  }
  recorder().finish();
  EXPECT_EQ(folders(), (std::vector<std::string>{"run-0001", "run-0002"}));
}

TEST_F(RecorderTest, ModeAlwaysWritesOneRecordingFromStartToStop) {
  settings_.mode = rig::RecorderSettings::Mode::always;
  ticks(10, State::starting);
  ticks(100, State::idle);
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  recorder().finish();
  ASSERT_EQ(folders().size(), 1U);
  EXPECT_EQ(lines(folders().front()).size(), 1 + 2 * 120U);
  EXPECT_EQ(json(folders().front())["sequence"]["name"], "pick stone");
}

TEST_F(RecorderTest, ModeOffRecordsNothing) {
  settings_.mode = rig::RecorderSettings::Mode::off;
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  recorder().finish();
  EXPECT_TRUE(folders().empty());
}

TEST_F(RecorderTest, ANamedFolderOverrulesTheMode) {
  settings_.mode = rig::RecorderSettings::Mode::off;
  only_folder_ = temporary_.path() + "/mine";
  ticks(10, State::idle);
  recorder().finish();
  EXPECT_EQ(folders(), std::vector<std::string>{"mine"});
  EXPECT_EQ(json("mine")["reason"], "always");
}

TEST_F(RecorderTest, DroppedRowsAreCounted) {
  event(Event::Kind::sequence_started, {}, 7);
  ticks(1, State::running);
  shared_.records_dropped.store(12);
  ticks(1, State::running);
  recorder().finish();
  EXPECT_EQ(json(folders().front())["dropped_rows"], 12);
  EXPECT_EQ(recorder().status().dropped_rows, 12U);
}

TEST_F(RecorderTest, AFullDiskEndsTheRecordingWithAnErrorEvent) {
  provenance_.virtual_time = false;  // use real time, so that every drain() writes to the file
  void (*handler)(int) = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{3000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  event(Event::Kind::sequence_started, {}, 7);
  ticks(100, State::running);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ticks(100, State::running);
  recorder().finish();
  ASSERT_EQ(folders().size(), 1U);
  EXPECT_EQ(json(folders().front())["state"], "stopped_early");
  EXPECT_NE(json(folders().front())["error"].get<std::string>().find("File too large"), std::string::npos);
  const std::string csv = text_of(temporary_.path() + "/" + folders().front() + "/run.csv");
  EXPECT_EQ(csv.back(), '\n');
  const auto events = log_.since(0, 100);
  EXPECT_EQ(events.back().kind, "recording_failed");
  EXPECT_EQ(events.back().severity, Severity::error);
  EXPECT_EQ(json(folders().front())["rows"], lines(folders().front()).size() - 1)
      << "rows that could not be written are not counted";
  EXPECT_EQ(json(folders().front())["duration_s"].get<double>(), std::stod(lines(folders().front()).back()));
  EXPECT_FALSE(recorder().status().active);
  EXPECT_FALSE(recorder().status().error.empty());
}

/// A small disk in memory. is_mounted() returns false if the user of the test may not mount a disk.
class SmallDisk {
 public:
  SmallDisk(std::string path, const char* size) : path_(std::move(path)) {
    std::filesystem::create_directory(path_);
    mounted_ = ::mount("none", path_.c_str(), "tmpfs", 0, size) == 0;
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  SmallDisk(SmallDisk&&) = delete;
  SmallDisk& operator=(SmallDisk&&) = delete;
  ~SmallDisk() {
    if (mounted_) ::umount(path_.c_str());
  }
  [[nodiscard]] bool is_mounted() const { return mounted_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool mounted_ = false;
};

TEST_F(RecorderTest, RunJsonDescribesTheRowsThatFitOnAFullDisk) {
  for (const bool virtual_time : {false, true}) {
    SCOPED_TRACE(virtual_time ? "virtual time" : "real time");
    const SmallDisk disk(temporary_.path() + "/disk", virtual_time ? "size=400k" : "size=120k");
    if (!disk.is_mounted()) GTEST_SKIP() << "this user may not mount a disk";
    provenance_.virtual_time = virtual_time;
    settings_.directory = disk.path();
    recorder_.reset();
    const Nanoseconds began = now_;
    event(Event::Kind::sequence_started, {}, 7);
    for (int i = 0; i < 70; ++i) {
      ticks(100, State::running);
      event(Event::Kind::fault_latched, control::FaultCode::reading_jumped);
    }
    recorder().finish();
    EXPECT_GT(now_ - began, 61 * ns_per_s) << "the recorder has tried to record again";
    std::size_t most_rows = 0;
    nlohmann::json first;
    for (const auto& entry : std::filesystem::directory_iterator(disk.path())) {
      const std::string name = "disk/" + entry.path().filename().string();
      SCOPED_TRACE(name);
      const auto rows = lines(name);
      ASSERT_FALSE(rows.empty()) << "an attempt on the full disk leaves no empty folder";
      const auto story = json(name);
      EXPECT_NE(story["state"], "recording");
      EXPECT_EQ(story["rows"], rows.size() - 1);
      EXPECT_EQ(story["duration_s"].get<double>(), rows.size() > 1 ? std::stod(rows.back()) : 0);
      if (rows.size() > most_rows) first = story;
      most_rows = std::max(most_rows, rows.size());
    }
    EXPECT_GT(most_rows, 500U);
    EXPECT_LT(most_rows, 14'000U);
    EXPECT_EQ(first["state"], "stopped_early");
    EXPECT_NE(first["error"].dump().find("No space left"), std::string::npos);
  }
}

/// A folder with the name of run.json makes the replacement fail, also for the user root.
TEST_F(RecorderTest, AFailureOfRunJsonDoesNotEndTheRecording) {
  provenance_.virtual_time = false;
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  ASSERT_EQ(folders().size(), 1U);
  const std::filesystem::path path = std::filesystem::path(temporary_.path()) / folders().front();
  std::filesystem::remove(path / "run.json");
  std::filesystem::create_directories(path / "run.json" / "in the way");
  ticks(600, State::idle);
  const auto events = log_.since(0, 100);
  EXPECT_EQ(events.back().kind, "recording_failed");
  EXPECT_NE(events.back().text.find("Recorded all "), std::string::npos) << events.back().text;
  event(Event::Kind::sequence_started, {}, 8);
  ticks(10, State::running);
  recorder().finish();
  EXPECT_EQ(folders().size(), 2U) << "the next recording starts at once";
}

TEST_F(RecorderTest, ANewRecordingStartsAMinuteAfterAWriteFailure) {
  settings_.directory = "/proc/softgrip";
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  EXPECT_EQ(log_.since(0, 100).size(), 1U) << "the write failure is reported once, not for every row";
  settings_.directory = temporary_.path();
  ticks(6100, State::idle);
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  recorder().finish();
  EXPECT_EQ(folders().size(), 1U);
}

TEST_F(RecorderTest, ARecordingThatBeginsInTheMiddleOfASequenceStatesTheSequence) {
  settings_.directory = "/proc/softgrip";
  event(Event::Kind::sequence_started, {}, 7);
  ticks(10, State::running);
  settings_.directory = temporary_.path();
  ticks(6100, State::running);
  ticks(100, State::idle);
  ticks(10, State::stopping);
  recorder().finish();
  ASSERT_EQ(folders(), (std::vector<std::string>{"run-0001_pick_stone", "run-0002"}));
  EXPECT_EQ(json(folders()[0])["sequence"]["request"], 7);
  EXPECT_TRUE(json(folders()[1])["sequence"].is_null()) << "the sequence has ended before this recording";
}

TEST_F(RecorderTest, EachStartInThePauseAfterADiskErrorIsReported) {
  settings_.directory = "/proc/softgrip";
  for (int run = 0; run < 3; ++run) {
    event(Event::Kind::sequence_started, {}, 7);
    ticks(10, State::running);
    ticks(100, State::idle);
  }
  const auto events = log_.since(0, 100);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].kind, "recording_failed");
  for (const std::size_t second : {1U, 2U}) {
    EXPECT_EQ(events[second].kind, "recording_skipped");
    EXPECT_NE(events[second].text.find("'pick stone' is not recorded"), std::string::npos)
        << events[second].text;
  }
}

TEST_F(RecorderTest, RunJsonExistsFromTheFirstRow) {
  event(Event::Kind::sequence_started, {}, 7);
  ticks(1, State::running);
  EXPECT_EQ(json(folders().front())["state"], "recording");
}

TEST_F(RecorderTest, InvalidUtf8KeepsRunJsonReadable) {
  provenance_.rig = "bench \xff";
  settings_.mode = rig::RecorderSettings::Mode::always;
  ticks(1, State::idle);
  recorder().finish();
  EXPECT_EQ(json(folders().front())["state"], "complete");
}

}  // namespace
}  // namespace softgrip::daemon::recorder_test
