#include "tools/web/commander.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "base/files.h"
#include "base/net/listener.h"

namespace softgrip::web::commander_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(CommandInABody, AcceptsStopAndStartCommands) {
  for (const char* good : {R"({"command":"stop"})", R"({"command":"start","sequence":"pick"})",
                           R"({"command":"start","sequence":"pick","parameters":{"squeeze_kpa":4.5}})"}) {
    const auto command = command_in(good);
    ASSERT_TRUE(command) << command.error();
    EXPECT_EQ(*command, nlohmann::ordered_json::parse(good));
  }
}

TEST(CommandInABody, RefusesEveryOtherBody) {
  for (const std::string& bad :
       {std::string(), std::string("[]"), std::string("{"), std::string("\"stop\""),
        std::string(R"({"command":"subscribe"})"), std::string(R"({"command":7})"),
        std::string(R"({"command":"stop","id":4})"), std::string(R"({"command":"vent","sequence":"pick"})"),
        std::string(R"({"command":"start"})"), std::string(R"({"command":"start","sequence":""})"),
        std::string(R"({"command":"start","sequence":{}})"),
        std::string(R"({"command":"start","sequence":"p","sequence_text":"steps: []"})"),
        std::string(R"({"command":"start","sequence":"p","dry_run":true})"),
        std::string(R"({"command":"start","sequence":"p","parameters":[1]})"),
        std::string(R"({"command":"start","sequence":"p","parameters":{"a":"1"}})"),
        R"({"command":"start","sequence":")" + std::string(129, 'a') + "\"}", std::string(16000, '['),
        std::string("\xff\xfe\x00{", 4)})
    EXPECT_FALSE(command_in(bad)) << bad;
}

TEST(Commander, RefusesACommandWithoutADaemonOrASocket) {
  const std::string nowhere = "/nowhere/softgripd.sock";
  Commander commander(nowhere);
  const auto sent = commander.send({{"command", "stop"}}, 0);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error()["error"]["code"], "no_daemon");
  const std::string none;
  Commander read_only(none);
  EXPECT_EQ(read_only.send({{"command", "stop"}}, 0).error()["error"]["code"], "not_allowed");
}

TEST(Commander, PendingStartsDoNotBlockAStopOrAVent) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/daemon.sock";
  const auto daemon = net::listen_unix(path);
  ASSERT_TRUE(daemon) << daemon.error();
  Commander commander(path);
  const Json start{{"command", "start"}, {"sequence", "pick"}};
  while (commander.send(start, 0)) {
  }
  EXPECT_EQ(commander.send(start, 0).error()["error"]["code"], "busy");
  for (const char* urgent : {"stop", "vent"}) {
    const auto sent = commander.send({{"command", urgent}}, 0);
    ASSERT_TRUE(sent) << sent.error();
    commander.abandon(*sent);
  }
  for (std::size_t i = 0; i < Commander::max_pending; ++i) {
    const auto sent = commander.send({{"command", "stop"}}, 0);
    ASSERT_TRUE(sent) << i;
    commander.abandon(*sent);
  }
}

TEST(Commander, ReportsADaemonThatDoesNotReply) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/daemon.sock";
  const auto daemon = net::listen_unix(path);
  ASSERT_TRUE(daemon) << daemon.error();
  Commander commander(path);
  bool ended = false;
  for (int i = 0; i < 5000 && !ended; ++i) {
    const auto sent = commander.send({{"command", "stop"}}, 0);
    commander.update(0);
    // If the daemon does not accept a request, the commander must produce an error response itself.
    const auto response = sent ? commander.take_response(*sent, 0) : std::nullopt;
    ended = response && (*response)["error"]["code"] == "no_answer";
    if (sent && !response) commander.abandon(*sent);
  }
  EXPECT_TRUE(ended);
}

/// Tests with a simulated daemon: the test reads and writes the lines of the daemon.
class CommanderTest : public ::testing::Test {
 protected:
  CommanderTest() : listener_(std::move(*net::listen_unix(path_))) {}

  std::uint64_t start() {
    const auto sent = commander_.send({{"command", "start"}, {"sequence", "pick"}}, now_);
    EXPECT_TRUE(sent);
    return sent.value_or(0);
  }
  /// Returns the requests that have arrived at the daemon since the last call. Omits hello requests.
  std::vector<Json> received() {
    while (Descriptor next = net::accept_client(listener_)) client_ = std::move(next);
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t count = 1; count > 0 && client_;) {
      count = ::recv(client_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    std::vector<Json> lines;
    for (std::size_t end = 0; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
      Json line = Json::parse(text.substr(0, end));
      if (line["command"] != "hello") lines.push_back(std::move(line));
    }
    return lines;
  }
  void reply(const Json& to, Json rest) {
    rest["id"] = to["id"];
    const std::string line = rest.dump() + "\n";
    ASSERT_EQ(::send(client_.get(), line.data(), line.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(line.size()));
    commander_.update(now_);
  }
  void pass(double duration_s) {
    now_ += static_cast<Nanoseconds>(duration_s * static_cast<double>(ns_per_s));
    commander_.update(now_);
  }
  /// Checks that exactly one new request has arrived and that it stops this start. Returns the new request.
  Json expect_stop_of(const Json& start) {
    const std::vector<Json> lines = received();
    EXPECT_EQ(lines.size(), 1U);
    if (lines.size() != 1) return {};
    EXPECT_EQ(lines[0]["command"], "stop");
    EXPECT_EQ(lines[0]["start_id"], start["start_id"]);
    return lines[0];
  }
  void expect_no_stop_any_more() {
    for (int i = 0; i < 10; ++i) {
      pass(1);
      EXPECT_TRUE(received().empty());
    }
  }

  const Json accepted_ = Json::parse(R"({"ok":true,"result":{"request":1}})");
  const Json no_such_start_ = Json::parse(
      R"({"ok":false,"error":{"code":"refused","message":"","refusal":{"code":"R12","name":"named_start_not_running"}}})");
  const ScratchFolder folder_;
  std::string path_ = folder_.path() + "/daemon.sock";
  Descriptor listener_;
  Descriptor client_;
  Commander commander_{path_};
  Nanoseconds now_ = 100 * ns_per_s;
};

TEST_F(CommanderTest, OnlyStartsHaveAUniqueStartId) {
  start();
  start();
  EXPECT_TRUE(commander_.send({{"command", "stop"}}, now_));
  const std::vector<Json> lines = received();
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_NE(lines[0]["start_id"], lines[1]["start_id"]);
  EXPECT_FALSE(lines[2].contains("start_id"));
}

/// A daemon without a free connection processes only the first line.
TEST(Commander, AStopOrAVentIsTheFirstLineOfAConnection) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/daemon.sock";
  const auto daemon = net::listen_unix(path);
  ASSERT_TRUE(daemon) << daemon.error();
  const auto first_line_after = [&](const char* command) {
    Commander commander(path);
    EXPECT_TRUE(commander.send({{"command", command}, {"sequence", "pick"}}, 0));
    const Descriptor client = net::accept_client(*daemon);
    std::array<char, 4096> buffer{};
    const ssize_t count = ::recv(client.get(), buffer.data(), buffer.size(), 0);
    const std::string text(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
    return Json::parse(text.substr(0, text.find('\n')))["command"].get<std::string>();
  };
  EXPECT_EQ(first_line_after("vent"), "vent");
  EXPECT_EQ(first_line_after("stop"), "stop");
  EXPECT_EQ(first_line_after("start"), "hello");
}

TEST_F(CommanderTest, AStartWithoutAnAnswerIsStopped) {
  const std::uint64_t number = start();
  const Json line = received().at(0);
  pass(7.9);
  EXPECT_FALSE(commander_.take_response(number, now_));
  pass(0.2);
  const auto response = commander_.take_response(number, now_);
  ASSERT_TRUE(response);
  EXPECT_EQ((*response)["error"]["code"], "no_answer");
  const Json stop = expect_stop_of(line);
  reply(line, accepted_);
  EXPECT_TRUE(received().empty()) << "the stop of this start has already been sent";
  reply(stop, accepted_);
  expect_no_stop_any_more();
}

TEST_F(CommanderTest, StopsAStartWhoseClientDisconnects) {
  const std::uint64_t waits = start();
  const Json line = received().at(0);
  EXPECT_TRUE(commander_.is_open_start(waits));
  commander_.abandon(waits);
  reply(expect_stop_of(line), no_such_start_);
  const std::uint64_t answered = start();
  const Json second = received().at(0);
  reply(second, accepted_);
  EXPECT_TRUE(commander_.is_open_start(answered));
  commander_.abandon(answered);
  reply(expect_stop_of(second), accepted_);
  expect_no_stop_any_more();
}

TEST_F(CommanderTest, DoesNotStopAStartWhoseOutcomeIsKnown) {
  const std::uint64_t accepted = start();
  reply(received().at(0), accepted_);
  EXPECT_EQ(commander_.take_response(accepted, now_)->at("ok"), true);
  commander_.abandon(accepted);
  const std::uint64_t refused = start();
  reply(received().at(0), {{"ok", false}, {"error", {{"code", "busy"}, {"message", ""}}}});
  EXPECT_FALSE(commander_.is_open_start(refused));
  commander_.abandon(refused);
  expect_no_stop_any_more();
}

TEST_F(CommanderTest, StopsAStartThatTheControlLoopDidNotConfirm) {
  const std::uint64_t number = start();
  const Json line = received().at(0);
  reply(line, {{"ok", false}, {"error", {{"code", "no_answer"}, {"message", ""}}}});
  EXPECT_EQ(commander_.take_response(number, now_)->at("error").at("code"), "no_answer");
  const Json stop = expect_stop_of(line);
  reply(stop, {{"ok", false}, {"error", {{"code", "no_answer"}, {"message", ""}}}});
  pass(1);
  reply(expect_stop_of(line), accepted_);
  expect_no_stop_any_more();
}

TEST_F(CommanderTest, SendsAPendingStopAfterReconnecting) {
  const std::uint64_t number = start();
  const Json line = received().at(0);
  client_.reset();
  listener_.reset();
  ::unlink(path_.c_str());
  pass(1);
  EXPECT_EQ(commander_.take_response(number, now_)->at("error").at("code"), "no_answer");
  pass(1);
  listener_ = std::move(*net::listen_unix(path_));
  pass(1);
  const Json stop = expect_stop_of(line);
  reply(stop, no_such_start_);
  expect_no_stop_any_more();
}

TEST_F(CommanderTest, AtTheEndOfTheProgramEveryOpenStartIsStopped) {
  start();
  const Json line = received().at(0);
  commander_.abandon_all();
  expect_stop_of(line);
}

}  // namespace
}  // namespace softgrip::web::commander_test
