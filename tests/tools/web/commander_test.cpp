#include "tools/web/commander.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "drivers/modbus_server/listener.h"

namespace softgrip::web::commander_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(CommandInABody, IsOneThatTheDaemonHas) {
  for (const char* good : {R"({"command":"stop"})", R"({"command":"start","sequence":"pick"})",
                           R"({"command":"start","sequence":"pick","parameters":{"squeeze_kpa":4.5}})"}) {
    const auto command = command_in(good);
    ASSERT_TRUE(command) << command.error();
    EXPECT_EQ(*command, nlohmann::ordered_json::parse(good));
  }
}

TEST(CommandInABody, NothingElseComesThrough) {
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

TEST(Commander, WithoutADaemonItSaysSo) {
  const std::string nowhere = "/nowhere/softgripd.sock";
  Commander commander(nowhere);
  const auto sent = commander.send({{"command", "stop"}}, 0);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error()["error"]["code"], "no_daemon");
  const std::string none;
  Commander looking(none);
  EXPECT_EQ(looking.send({{"command", "stop"}}, 0).error()["error"]["code"], "not_allowed");
}

TEST(Commander, StartsThatWaitKeepNoStopFromTheDaemon) {
  const std::string path = "/tmp/commander_" + std::to_string(::getpid());
  const auto daemon = modbus::listen_unix(path);
  ASSERT_TRUE(daemon) << daemon.error();
  Commander commander(path);
  const Json start{{"command", "start"}, {"sequence", "pick"}};
  while (commander.send(start, 0)) {
  }
  EXPECT_EQ(commander.send(start, 0).error()["error"]["code"], "busy");
  for (const char* urgent : {"stop", "vent"}) {
    const auto sent = commander.send({{"command", urgent}}, 0);
    ASSERT_TRUE(sent) << sent.error();
    commander.forget(*sent);
  }
  for (std::size_t i = 0; i < Commander::most_waiting; ++i) {
    const auto sent = commander.send({{"command", "stop"}}, 0);
    ASSERT_TRUE(sent) << i;
    commander.forget(*sent);
  }
  ::unlink(path.c_str());
}

TEST(Commander, ADaemonThatHangsHoldsNoOne) {
  const std::string path = "/tmp/commander_hangs_" + std::to_string(::getpid());
  const auto daemon = modbus::listen_unix(path);
  ASSERT_TRUE(daemon) << daemon.error();
  Commander commander(path);
  bool ended = false;
  for (int i = 0; i < 5000 && !ended; ++i) {
    const auto sent = commander.send({{"command", "stop"}}, 0);
    commander.look_after();
    // The one that the daemon does not take is answered.
    const auto answer = sent ? commander.take_answer(*sent, 0) : std::nullopt;
    ended = answer && (*answer)["error"]["code"] == "no_answer";
    if (sent && !answer) commander.forget(*sent);
  }
  EXPECT_TRUE(ended);
  ::unlink(path.c_str());
}

}  // namespace
}  // namespace softgrip::web::commander_test
