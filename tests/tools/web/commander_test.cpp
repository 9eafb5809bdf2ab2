#include "tools/web/commander.h"

#include <gtest/gtest.h>

#include <string>

namespace softgrip::web::commander_test {
namespace {

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

}  // namespace
}  // namespace softgrip::web::commander_test
