// Tests a running softgripd. Normal clients and hostile clients connect to its socket.

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <csignal>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "tests/daemon/service/softgripd_process.h"
#include "tests/support/files.h"

namespace softgrip::daemon::socket_session_test {
namespace {

using nlohmann::json;
using testing::ApiClient;
using testing::make_rig;
using testing::SoftgripdProcess;

class SocketSession : public ::testing::Test {
 protected:
  SocketSession()
      : process_(folder_.path(), {.arguments = {"--config", make_rig(folder_.path())}}), client_(socket()) {}
  void SetUp() override {
    ASSERT_TRUE(client_.open()) << process_.output();
    ASSERT_TRUE(until_state("idle"));
  }
  std::string socket() const { return folder_.path() + "/socket"; }
  json ask(const json& request) { return client_.ask(request); }
  json status() { return ask({{"command", "status"}})["result"]; }
  bool until_state(const std::string& state) {
    for (int i = 0; i < 500; ++i) {
      if (status()["state"] == state) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }

  ScratchFolder folder_;
  SoftgripdProcess process_;
  ApiClient client_;
};

TEST_F(SocketSession, AGripCanBeStartedObservedAndVented) {
  const json start = ask({{"id", 1}, {"command", "start"}, {"sequence", "pick_stone.yaml"}});
  EXPECT_EQ(start["id"], 1);
  ASSERT_EQ(start["ok"], true) << start;
  const auto request = start["result"]["request"].get<std::uint32_t>();
  ASSERT_TRUE(until_state("running"));

  const json again = ask({{"id", 2}, {"command", "start"}, {"sequence", "pick_stone"}});
  EXPECT_EQ(again["ok"], false);
  EXPECT_EQ(again["error"]["code"], "refused");
  EXPECT_EQ(again["error"]["refusal"]["name"], "not_idle");

  const json seen = status();
  EXPECT_EQ(seen["sequence"]["name"], "pick_stone");
  EXPECT_EQ(seen["sequence"]["request"], request);
  EXPECT_EQ(seen["sequence"]["ended"], nullptr);
  EXPECT_EQ(seen["recording"]["active"], true);

  EXPECT_EQ(ask({{"command", "vent"}})["ok"], true);
  ASSERT_TRUE(until_state("idle"));
  EXPECT_EQ(status()["sequence"]["ended"], "stopped");
  const json events = ask({{"command", "events"}})["result"];
  bool started = false;
  for (const json& event : events["events"]) {
    started = started || (event["kind"] == "sequence_started" && event["request"] == request);
  }
  EXPECT_TRUE(started);
  const auto newest = events["newest"].get<std::uint64_t>();
  const json later = ask({{"command", "events"}, {"since", newest}})["result"]["events"];
  for (const json& event : later) EXPECT_GT(event["id"].get<std::uint64_t>(), newest);
}

TEST_F(SocketSession, ANamedStopEndsOnlyTheNamedStart) {
  const auto start = [&](const char* id) {
    return ask({{"command", "start"}, {"sequence", "pick_stone"}, {"start_id", id}});
  };
  const auto stop_of = [&](const char* key, const json& value) {
    return ask({{"command", "stop"}, {key, value}});
  };
  const json first = start("cell/1");
  ASSERT_EQ(first["ok"], true) << first;
  const auto request = first["result"]["request"].get<std::uint32_t>();
  for (const auto& [key, value] : std::vector<std::pair<const char*, json>>{
           {"start_id", "cell/2"}, {"request", request + 1}, {"request", 4294967295U}}) {
    EXPECT_EQ(stop_of(key, value)["error"]["refusal"]["name"], "named_start_not_running") << key << value;
  }
  EXPECT_EQ(status()["sequence"]["ended"], nullptr) << "none of these stop requests refers to this start";
  EXPECT_EQ(start("cell/1")["error"]["code"], "bad_request") << "this start id is already in use";
  EXPECT_EQ(stop_of("start_id", "cell/1")["ok"], true);
  ASSERT_TRUE(until_state("idle"));
  EXPECT_EQ(status()["sequence"]["ended"], "stopped");

  const json second = start("cell/3");
  ASSERT_EQ(second["ok"], true) << second;
  EXPECT_EQ(stop_of("start_id", "cell/1")["error"]["refusal"]["code"], "R12");
  EXPECT_EQ(stop_of("request", request)["error"]["refusal"]["code"], "R12");
  EXPECT_EQ(status()["sequence"]["ended"], nullptr)
      << "the stop requests refer to an earlier start, so the sequence continues";
  EXPECT_EQ(stop_of("request", second["result"]["request"])["ok"], true);
}

TEST_F(SocketSession, ANamedStopPreventsAStartThatArrivesLater) {
  EXPECT_EQ(ask({{"command", "stop"}, {"start_id", "late"}})["error"]["refusal"]["code"], "R12");
  const json late = ask({{"command", "start"}, {"sequence", "pick_stone"}, {"start_id", "late"}});
  EXPECT_EQ(late["error"]["code"], "abandoned");
  // Send a stop immediately after a start. The sequence must not run, even if the daemon has already begun to
  // process the start.
  for (int i = 0; i < 20; ++i) {
    const std::string id = "at once " + std::to_string(i);
    client_.send(R"({"id":1,"command":"start","sequence":"pick_stone","start_id":")" + id + "\"}\n");
    if (i % 2 == 1) std::this_thread::sleep_for(std::chrono::milliseconds(i));
    client_.send(R"({"id":2,"command":"stop","start_id":")" + id + "\"}\n");
    for (int replies = 0; replies < 2; ++replies) ASSERT_TRUE(client_.receive().contains("ok"));
    const json after = status();
    EXPECT_FALSE(after["state"] == "running" || after["state"] == "resynchronising") << after;
    ASSERT_TRUE(until_state("idle"));
  }
}

TEST_F(SocketSession, APausedDaemonExecutesTheStopOfALostClient) {
  const auto line = [](const char* command, const std::string& rest) {
    return std::string(R"({"command":")") + command + "\"" + rest + ",\"start_id\":\"x\"}\n";
  };
  ASSERT_EQ(ask(json::parse(line("start", R"(,"sequence":"pick_stone")")))["ok"], true);
  ASSERT_TRUE(until_state("running"));
  {
    ApiClient watching(socket());
    ASSERT_TRUE(watching.open());
    watching.send("{\"command\":\"events\",\"limit\":1000}\n{\"command\":\"watch\",\"rate_hz\":50}\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    process_.signal(SIGSTOP);
    // This client has not read its messages, so its connection ends with a reset by the kernel.
    watching.send(line("stop", ""));
  }
  process_.signal(SIGCONT);
  ASSERT_TRUE(until_state("idle"));
  EXPECT_EQ(status()["sequence"]["ended"], "stopped");
}

TEST_F(SocketSession, InadmissibleRequestsAreRefusedWithTheReason) {
  EXPECT_EQ(ask({{"command", "stop"}})["error"]["refusal"]["name"], "nothing_to_stop");
  EXPECT_EQ(ask({{"command", "acknowledge"}})["error"]["refusal"]["name"], "nothing_to_acknowledge");
}

TEST_F(SocketSession, AnInvalidSequenceIsRefusedWithFileAndLine) {
  const json reply =
      ask({{"command", "start"},
           {"sequence", "mine"},
           {"sequence_text", "name: mine\nsteps:\n  - move: {displacement_mm: 500}\n  - fly: {}\n"}});
  EXPECT_EQ(reply["error"]["code"], "sequence_refused");
  ASSERT_GE(reply["error"]["problems"].size(), 1U) << reply;
  EXPECT_EQ(reply["error"]["problems"][0]["file"], "mine");
  EXPECT_GE(reply["error"]["problems"][0]["line"], 3);
  for (const std::string name : {"../rig", "/etc/passwd", ".hidden", "none"}) {
    EXPECT_EQ(ask({{"command", "start"}, {"sequence", name}})["error"]["code"], "sequence_refused") << name;
  }
  EXPECT_EQ(status()["state"], "idle");
}

TEST_F(SocketSession, TheSequencesAreListedWithTheirParameters) {
  const json list = ask({{"id", 4}, {"command", "sequences"}});
  EXPECT_EQ(list["id"], 4);
  bool seen = false;
  for (const json& sequence : list["result"]["sequences"]) {
    EXPECT_EQ(sequence["problems"], json::array());
    if (sequence["name"] != "pick_stone") continue;
    seen = true;
    ASSERT_GE(sequence["parameters"].size(), 1U);
    EXPECT_EQ(sequence["parameters"][0]["name"], "squeeze_kpa");
    EXPECT_EQ(sequence["parameters"][0]["unit"], "kpa");
  }
  EXPECT_TRUE(seen) << list;
}

TEST_F(SocketSession, AStartSetsSequenceParameters) {
  const auto start = [&](const json& parameters) {
    return ask({{"command", "start"}, {"sequence", "pick_stone"}, {"parameters", parameters}});
  };
  const json wrong = start({{"squeeze_kpa", 400}});
  EXPECT_EQ(wrong["error"]["code"], "sequence_refused");
  EXPECT_EQ(start({{"no_parameter", 4}})["error"]["code"], "sequence_refused");
  ASSERT_EQ(start({{"squeeze_kpa", 4}})["ok"], true);
  EXPECT_EQ(status()["sequence"]["parameters"]["squeeze_kpa"], 4.0);
}

TEST_F(SocketSession, ASequenceCanBeSentAsText) {
  const json reply =
      ask({{"command", "start"},
           {"sequence", "inline.yaml"},
           {"sequence_text", test::text_of(SOFTGRIP_SOURCE_DIR "/config/sequences/pick_stone.yaml")}});
  EXPECT_EQ(reply["ok"], true) << reply;
  EXPECT_TRUE(until_state("running"));
}

TEST_F(SocketSession, WatchStreamsNearTheRequestedRate) {
  ASSERT_EQ(ask({{"id", 9}, {"command", "watch"}, {"rate_hz", 20}})["ok"], true);
  std::vector<double> times;
  for (int i = 0; i < 20; ++i) {
    const json line = client_.receive();
    ASSERT_TRUE(line.contains("watch")) << line;
    EXPECT_EQ(line["id"], 9);
    times.push_back(line["watch"]["time_s"]);
  }
  const double period_s = (times.back() - times.front()) / 19;
  EXPECT_GT(period_s, 0.04);
  EXPECT_LT(period_s, 0.5) << "the loop may be slow on a loaded machine, but it must continue";
}

TEST_F(SocketSession, StatisticsContainHistogramsOnRequest) {
  const json plain = ask({{"command", "statistics"}})["result"];
  EXPECT_GT(plain["loop"]["ticks"], 0);
  EXPECT_FALSE(plain["loop"]["wake_up"].contains("bins_us"));
  const json full = ask({{"command", "statistics"}, {"histograms", true}})["result"];
  std::uint64_t sum = 0;
  for (const json& bin : full["loop"]["wake_up"]["bins_us"]) sum += bin[1].get<std::uint64_t>();
  EXPECT_NEAR(static_cast<double>(sum), full["loop"]["wake_up"]["count"].get<double>(), 5);
}

TEST_F(SocketSession, HostileClientsDoNotDisturbOtherClients) {
  const unsigned seed = 99;
  SCOPED_TRACE(seed);
  const auto ticks_before = status()["loop"]["ticks"].get<std::uint64_t>();
  std::vector<std::thread> crowd;
  for (unsigned i = 0; i < 6; ++i) {
    crowd.emplace_back([this, i] {
      std::mt19937 random(seed + i);
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(3);
      while (std::chrono::steady_clock::now() < end) {
        ApiClient hostile(socket());
        if (!hostile.open()) continue;
        std::string text(random() % 100'000, '\0');
        for (char& c : text) c = static_cast<char>(random() % 7 == 0 ? '\n' : random() % 256);
        if (i % 3 == 1) {  // this client never reads the response to its request
          text.clear();
          for (int n = 0; n < 5000; ++n) text += "{\"command\":\"statistics\",\"histograms\":true}\n";
        }
        if (i % 3 == 2) text = std::string(200'000, '[');
        ::send(hostile.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      }
    });
  }
  int answered = 0;
  for (int i = 0; i < 20; ++i) {
    if (ask({{"id", i}, {"command", "status"}})["id"] == i) ++answered;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  for (std::thread& thread : crowd) thread.join();
  EXPECT_EQ(answered, 20);
  const json after = status();
  EXPECT_EQ(after["state"], "idle");
  EXPECT_GT(after["loop"]["ticks"].get<std::uint64_t>(), ticks_before + 200);
  process_.signal(SIGTERM);
  EXPECT_EQ(process_.wait(), 0) << process_.output();
}

}  // namespace
}  // namespace softgrip::daemon::socket_session_test
