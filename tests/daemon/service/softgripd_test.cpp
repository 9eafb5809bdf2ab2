// Tests softgripd as a process: normal runs, several runs in succession, a stop, a kill and a full disk.

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/descriptor.h"
#include "base/files.h"
#include "tests/daemon/service/softgripd_process.h"
#include "tests/support/files.h"

namespace softgrip::daemon::softgripd_test {
namespace {

using nlohmann::json;
using test::text_of;
using testing::ApiClient;
using testing::make_rig;
using testing::SoftgripdProcess;

const std::string sequences = SOFTGRIP_SOURCE_DIR "/config/sequences/";
constexpr double rate_hz = 200;

/// Header and cells of a file run.csv.
struct Csv {
  std::vector<std::vector<std::string>> rows;  ///< all rows of the file except the header
  std::vector<std::string> header;

  explicit Csv(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells(1);
      for (const char c : line) {
        if (c == ',') {
          cells.emplace_back();
        } else {
          cells.back() += c;
        }
      }
      if (header.empty()) {
        header = cells;
      } else if (cells.size() == header.size()) {  // skip an incomplete last line, which a killed daemon can
                                                   // leave
        rows.push_back(cells);
      }
    }
  }
  [[nodiscard]] const std::string& cell(std::size_t row, const std::string& column) const {
    const auto found = std::find(header.begin(), header.end(), column);
    return rows.at(row).at(static_cast<std::size_t>(found - header.begin()));
  }
  [[nodiscard]] double last_time_s() const { return std::stod(cell(rows.size() - 1, "time_s")); }
};

class SoftgripdTest : public ::testing::Test {
 protected:
  std::string socket() const { return folder_.path() + "/socket"; }
  json run_json(const std::string& folder) const { return json::parse(text_of(folder + "/run.json")); }
  /// Returns the path of the run folder. The test fails if the folder of the rig does not contain exactly one
  /// run.
  std::string only_run() const {
    std::vector<std::string> folders;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() + "/runs")) {
      folders.push_back(entry.path().string());
    }
    EXPECT_EQ(folders.size(), 1U);
    return folders.empty() ? "" : folders.front();
  }
  static json status(ApiClient& client) { return client.ask({{"command", "status"}})["result"]; }
  static bool until_state(ApiClient& client, const std::string& state, double timeout_s = 10) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
    while (std::chrono::steady_clock::now() < end) {
      if (status(client)["state"] == state) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }

  ScratchFolder folder_;
};

TEST_F(SoftgripdTest, VirtualTimeGivesTheSameBytesFromTheSameSeed) {
  const std::string rig = make_rig(folder_.path());
  const auto run = [&](const std::string& name, const std::string& seed) {
    SoftgripdProcess process(folder_.path(), {.arguments = {"--config", rig, "--virtual-time", "--seed", seed,
                                                            "--sequence", sequences + "pick_stone.yaml",
                                                            "--record", folder_.path() + "/" + name}});
    EXPECT_EQ(process.wait(), 0) << process.output();
  };
  run("first", "7");
  run("second", "7");
  run("other", "8");
  const std::string first = text_of(folder_.path() + "/first/run.csv");
  EXPECT_GT(first.size(), 100'000U);
  EXPECT_TRUE(first == text_of(folder_.path() + "/second/run.csv"));
  EXPECT_EQ(text_of(folder_.path() + "/first/run.json"), text_of(folder_.path() + "/second/run.json"));
  EXPECT_FALSE(first == text_of(folder_.path() + "/other/run.csv"));
  EXPECT_EQ(run_json(folder_.path() + "/first")["seed"], 7);
}

TEST_F(SoftgripdTest, AStopSignalLeavesTheSafeOutputsAndACompleteRecording) {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const ScratchFolder folder;
    const std::string record = folder.path() + "/record";
    SoftgripdProcess process(folder.path(),
                             {.arguments = {"--config", make_rig(folder.path()), "--record", record}});
    ApiClient client(folder.path() + "/socket");
    ASSERT_TRUE(client.open()) << process.output();
    ASSERT_TRUE(until_state(client, "idle"));
    ASSERT_EQ(client.ask({{"command", "start"}, {"sequence", "pick_stone"}})["ok"], true);
    ASSERT_TRUE(until_state(client, "running"));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    EXPECT_GT(status(client)["channels"][0]["command_kpa"], 1.0);
    process.signal(signal);
    EXPECT_EQ(process.wait(), 0) << process.output();
    EXPECT_NE(process.output().find("confirmed the safe outputs"), std::string::npos);
    EXPECT_EQ(run_json(record)["state"], "complete");
    const Csv csv(text_of(record + "/run.csv"));
    EXPECT_EQ(csv.cell(csv.rows.size() - 1, "pressure_command_kpa"), "0");
    EXPECT_FALSE(std::filesystem::exists(folder.path() + "/socket"));
  }
}

TEST_F(SoftgripdTest, AKilledDaemonLosesLessThanASecondOfItsRecording) {
  const std::string record = folder_.path() + "/record";
  SoftgripdProcess process(folder_.path(),
                           {.arguments = {"--config", make_rig(folder_.path()), "--record", record}});
  ApiClient client(socket());
  ASSERT_TRUE(client.open()) << process.output();
  ASSERT_TRUE(until_state(client, "idle"));
  ASSERT_EQ(client.ask({{"command", "start"}, {"sequence", "pick_stone"}})["ok"], true);
  ASSERT_TRUE(until_state(client, "running"));
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  const double recorded_s =
      static_cast<double>(status(client)["loop"]["ticks"].get<std::uint64_t>()) / rate_hz;
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait(), 128 + SIGKILL);
  const Csv csv(text_of(record + "/run.csv"));
  EXPECT_GE(csv.last_time_s(), recorded_s - 1);
  const json story = run_json(record);
  EXPECT_EQ(story["state"], "recording");
  EXPECT_EQ(story["sequence"]["name"], "pick_stone");
  EXPECT_FALSE(story["events"].empty());
}

TEST_F(SoftgripdTest, ADaemonReplacesTheSocketOfAKilledDaemon) {
  const std::string rig = make_rig(folder_.path());
  {
    SoftgripdProcess killed(folder_.path(), {.arguments = {"--config", rig}});
    ASSERT_TRUE(ApiClient(socket()).open()) << killed.output();
  }
  ASSERT_TRUE(std::filesystem::exists(socket()));
  SoftgripdProcess next(folder_.path(), {.arguments = {"--config", rig}});
  ApiClient client(socket());
  EXPECT_EQ(client.ask({{"command", "status"}})["ok"], true) << next.output();
}

TEST_F(SoftgripdTest, ASecondDaemonOnTheSameSocketIsRefused) {
  const std::string rig = make_rig(folder_.path());
  SoftgripdProcess first(folder_.path(), {.arguments = {"--config", rig}});
  ASSERT_TRUE(ApiClient(socket()).open()) << first.output();
  SoftgripdProcess second(folder_.path(), {.arguments = {"--config", rig}});
  EXPECT_EQ(second.wait(), 4);
  EXPECT_NE(second.output().find("another softgripd"), std::string::npos);
  EXPECT_TRUE(ApiClient(socket()).open());
}

TEST_F(SoftgripdTest, AFullDiskEndsTheRecordingAndNotTheGrip) {
  // Use a disk that is really full if the test may mount one. Otherwise limit the file size.
  const std::string disk = folder_.path() + "/disk";
  std::filesystem::create_directory(disk);
  const bool mounted = mount("none", disk.c_str(), "tmpfs", 0, "size=64k") == 0;
  SoftgripdProcess::Start start{
      .arguments = {"--config", make_rig(folder_.path()), "--record", disk + "/record"}};
  if (!mounted) {
    start.in_child = [] {
      const rlimit small{60'000, 60'000};
      setrlimit(RLIMIT_FSIZE, &small);
    };
  }
  {
    SoftgripdProcess process(folder_.path(), start);
    ApiClient client(socket());
    ASSERT_TRUE(client.open()) << process.output();
    ASSERT_TRUE(until_state(client, "idle"));
    const json short_hold{{"hold_s", 0.5}};
    ASSERT_EQ(
        client.ask({{"command", "start"}, {"sequence", "pick_stone"}, {"parameters", short_hold}})["ok"],
        true);
    ASSERT_TRUE(until_state(client, "running"));
    ASSERT_TRUE(until_state(client, "idle", 30)) << "the sequence runs to its end although the disk is full";
    const json end = status(client);
    EXPECT_EQ(end["sequence"]["ended"], "done");
    EXPECT_EQ(end["channels"][0]["result"], "RELEASED");
    EXPECT_EQ(end["recording"]["active"], false);
    const auto error = end["recording"]["error"].get<std::string>();
    EXPECT_NE(error.find(mounted ? "No space left" : "File too large"), std::string::npos) << error;
    const json events = client.ask({{"command", "events"}, {"limit", 1000}})["result"]["events"];
    EXPECT_TRUE(std::any_of(events.begin(), events.end(),
                            [](const json& event) { return event["kind"] == "recording_failed"; }));
    process.signal(SIGTERM);
    EXPECT_EQ(process.wait(), 4) << "the requested recording is incomplete";
  }
  const std::string csv = text_of(disk + "/record/run.csv");
  EXPECT_GT(csv.size(), 10'000U);
  EXPECT_EQ(csv.back(), '\n');
  EXPECT_TRUE(json::accept(text_of(disk + "/record/run.json")));
  if (mounted) umount(disk.c_str());
}

TEST_F(SoftgripdTest, EndsWithTheSequenceAndReportsTheResult) {
  const std::string rig = make_rig(folder_.path());
  SoftgripdProcess done(folder_.path(), {.arguments = {"--config", rig, "--virtual-time", "--sequence",
                                                       sequences + "pick_stone.yaml"}});
  EXPECT_EQ(done.wait(), 0) << done.output();
  const std::string empty = make_rig(folder_.path(), {{"object: {position_mm: 12, yielding: 0.1}", ""}});
  SoftgripdProcess failed(folder_.path(), {.arguments = {"--config", empty, "--virtual-time", "--sequence",
                                                         sequences + "pick_stone.yaml"}});
  EXPECT_EQ(failed.wait(), 6) << failed.output();
  EXPECT_NE(failed.output().find("NO PART"), std::string::npos);
  const std::string blind = make_rig(
      folder_.path(),
      {{"    plants:", "    events: [{at_s: 8, channel: left, sensor: out_of_range}]\n    plants:"}});
  SoftgripdProcess faulted(folder_.path(), {.arguments = {"--config", blind, "--virtual-time", "--sequence",
                                                          sequences + "pick_stone.yaml"}});
  EXPECT_EQ(faulted.wait(), 6) << faulted.output();
  EXPECT_NE(faulted.output().find("the sequence ended: faulted"), std::string::npos) << faulted.output();
}

TEST_F(SoftgripdTest, RefusesWithTheExitCodesOfTheManual) {
  const std::string rig = make_rig(folder_.path());
  const auto code = [&](std::vector<std::string> arguments) {
    return SoftgripdProcess(folder_.path(), {.arguments = std::move(arguments)}).wait();
  };
  EXPECT_EQ(code({}), 2);
  EXPECT_EQ(code({"--config", rig, "--fly"}), 2);
  EXPECT_EQ(code({"--config", rig, "--virtual-time"}), 2)
      << "in virtual time, softgripd requires an end of the run";
  for (const char* duration_s : {"nan", "1e10", "0", "-1", "long"})
    EXPECT_EQ(code({"--config", rig, "--virtual-time", "--duration-s", duration_s}), 2) << duration_s;
  for (const char* seed : {"-1", "18446744073709551616"})
    EXPECT_EQ(code({"--config", rig, "--virtual-time", "--duration-s", "0.1", "--seed", seed}), 2) << seed;
  const std::vector<std::string> recorded{"--config", rig,        "--virtual-time",       "--duration-s",
                                          "0.1",      "--record", folder_.path() + "/rec"};
  EXPECT_EQ(code(recorded), 0);
  EXPECT_EQ(code(recorded), 5) << "a recording is never overwritten";
  EXPECT_EQ(code({"--help"}), 0);
  EXPECT_EQ(code({"--version"}), 0);
  EXPECT_EQ(code({"--config", rig, "--check"}), 0);
  const std::string broken = make_rig(folder_.path(), {{"rate_hz: 200", "rate: 200"}});
  EXPECT_EQ(code({"--config", broken, "--check"}), 3);
  EXPECT_EQ(code({"--config", broken}), 3);
}

TEST_F(SoftgripdTest, AFileThatCannotBeReadIsAnInputError) {
  const std::string rig = make_rig(folder_.path());
  const std::string none = folder_.path() + "/none.yaml";
  const std::string pick = sequences + "pick_stone.yaml";
  for (const auto& [config, sequence, unread] :
       std::vector<std::array<std::string, 3>>{{none, pick, none},
                                               {folder_.path(), pick, folder_.path()},
                                               {rig, none, none},
                                               {rig, sequences, sequences}}) {
    for (const std::string mode : {"--virtual-time", "--check"}) {
      SoftgripdProcess process(folder_.path(),
                               {.arguments = {"--config", config, "--sequence", sequence, mode}});
      EXPECT_EQ(process.wait(), 4) << unread << " " << mode;
      EXPECT_NE(process.output().find("softgripd: cannot read " + unread + ": "), std::string::npos)
          << process.output();
    }
  }
  for (const std::vector<std::string>& mode :
       {std::vector<std::string>{"--safe-outputs"}, std::vector<std::string>{"--device", "gpiochip0"}}) {
    std::vector<std::string> arguments{"--config", none};
    arguments.insert(arguments.end(), mode.begin(), mode.end());
    EXPECT_EQ(SoftgripdProcess(folder_.path(), {.arguments = arguments}).wait(), 4) << mode.front();
  }
}

TEST_F(SoftgripdTest, CheckRefusesAFileOfAnotherKindWithAReason) {
  const std::string rig = make_rig(folder_.path());
  const std::string pick = sequences + "pick_stone.yaml";
  const std::string model = SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml";
  const std::string map = SOFTGRIP_SOURCE_DIR "/config/boards/adam-6024.yaml";
  for (const auto& [config, sequence, reason] : std::vector<std::array<std::string, 3>>{
           {model, "", model + " is a model, but --config requires a rig"},
           {pick, "", pick + " is a sequence, but --config requires a rig"},
           {rig, rig, rig + " is a rig, but --sequence requires a sequence"},
           {rig, model, model + " is a model, but --sequence requires a sequence"},
           {rig, map, map + " is a board map, but --sequence requires a sequence"}}) {
    const ScratchFolder folder;
    std::vector<std::string> arguments{"--config", config, "--check"};
    if (!sequence.empty()) arguments.insert(arguments.end(), {"--sequence", sequence});
    SoftgripdProcess process(folder.path(), {.arguments = arguments});
    EXPECT_EQ(process.wait(), 3) << reason;
    EXPECT_NE(process.output().find("softgripd: " + reason), std::string::npos) << process.output();
    EXPECT_EQ(process.output().find("fit to run"), std::string::npos) << process.output();
  }
  SoftgripdProcess right(folder_.path(), {.arguments = {"--config", rig, "--sequence", pick, "--check"}});
  EXPECT_EQ(right.wait(), 0) << right.output();
}

TEST_F(SoftgripdTest, RefusesAnAmbiguousConverterNameWithoutWriting) {
  const std::filesystem::path root = folder_.path() + "/iio";
  for (const auto& [node, name] :
       {std::pair{"iio:device0", "mcp4725"}, {"iio:device1", "mcp4725"}, {"iio:device2", "ads1115"}}) {
    std::filesystem::create_directories(root / node);
    std::ofstream(root / node / "name") << name << "\n";
    std::ofstream(root / node / "out_voltage0_raw") << "1234\n";
  }
  std::string text = text_of(SOFTGRIP_SOURCE_DIR "/config/rig_iio.yaml");
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"  iio:\n", "  iio:\n    root: " + root.string() + "\n"},
           {"device: 1-0060", "device: mcp4725"},
           {"device: 1-0061", "device: mcp4725"},
           {"models/", SOFTGRIP_SOURCE_DIR "/config/models/"}}) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  }
  const std::string rig = folder_.path() + "/converters.yaml";
  std::ofstream(rig) << text;
  SoftgripdProcess refused(folder_.path(), {.arguments = {"--config", rig, "--no-socket"}});
  EXPECT_EQ(refused.wait(), 3);
  EXPECT_NE(refused.output().find("converters.yaml:11:18: `mcp4725` fits 2 converters: iio:device0 (name "
                                  "`mcp4725`) and iio:device1 (name `mcp4725`)"),
            std::string::npos)
      << refused.output();
  for (const char* const node : {"iio:device0", "iio:device1"})
    EXPECT_EQ(text_of((root / node / "out_voltage0_raw").string()), "1234\n") << node;
}

TEST_F(SoftgripdTest, RefusesARunIfRequiredRealTimeIsUnavailable) {
  const std::string rig =
      make_rig(folder_.path(),
               {{"required: false, priority: 70, cpus: []", "required: true, priority: 70, cpus: [1000]"}});
  SoftgripdProcess process(folder_.path(), {.arguments = {"--config", rig}});
  EXPECT_EQ(process.wait(), 1);
  EXPECT_NE(process.output().find("DEGRADED"), std::string::npos) << process.output();
  EXPECT_NE(process.output().find("confirmed the safe outputs"), std::string::npos);
}

/// A socket that receives the messages of sd_notify, like the socket of a service manager.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const timeval patience{3, 0};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  /// Returns the messages up to and including the first one that begins with `start`. Returns an empty list
  /// if no message begins with `start`.
  std::vector<std::string> until(const std::string& start) {
    std::vector<std::string> messages;
    for (;;) {
      std::string text(4096, '\0');
      const ssize_t count = recv(socket_.get(), text.data(), text.size(), 0);
      if (count <= 0) return {};
      text.resize(static_cast<std::size_t>(count));
      messages.push_back(text);
      if (text.rfind(start, 0) == 0) return messages;
    }
  }

 private:
  Descriptor socket_;
};

TEST_F(SoftgripdTest, NotifiesTheServiceManagerOfReadyAliveAndStopping) {
  const std::string path = folder_.path() + "/notify";
  NotifySocket manager(path);
  SoftgripdProcess process(folder_.path(),
                           {.arguments = {"--config", make_rig(folder_.path())},
                            .environment = {"NOTIFY_SOCKET=" + path, "WATCHDOG_USEC=400000"}});
  EXPECT_FALSE(manager.until("READY=1").empty()) << process.output();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(manager.until("WATCHDOG=1").empty());
  process.signal(SIGTERM);
  EXPECT_FALSE(manager.until("STOPPING=1").empty());
  EXPECT_EQ(process.wait(), 0);
}

}  // namespace
}  // namespace softgrip::daemon::softgripd_test
