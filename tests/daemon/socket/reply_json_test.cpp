#include "daemon/socket/reply_json.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/socket/socket_api.h"

namespace softgrip::daemon::reply_json_test {
namespace {

TEST(ReplyJson, AGreetingListsTheCommandsOfTheRole) {
  const rig::SocketSettings settings;
  const auto viewer = hello_json({"1.2", "2026-11-21T09:00:00.000Z", Role::look, "", 1}, settings);
  EXPECT_EQ(viewer["role"], "look");
  EXPECT_EQ(viewer["read_only"], true);
  EXPECT_TRUE(viewer["client"].is_null());
  EXPECT_EQ(viewer["bounds"]["max_clients"], settings.max_clients);
  const auto operating = hello_json({"1.2", "2026-11-21T09:00:00.000Z", Role::operate, "cell", 1}, settings);
  EXPECT_EQ(operating["client"], "cell");
  EXPECT_EQ(operating["role"], "operate");
  EXPECT_EQ(operating["read_only"], false);
  const auto may = [](const auto& hello, const char* command) {
    const auto& commands = hello["commands"];
    return std::find(commands.begin(), commands.end(), command) != commands.end();
  };
  EXPECT_TRUE(may(operating, "vent"));
  EXPECT_FALSE(may(viewer, "vent"));
  EXPECT_TRUE(may(viewer, "subscribe"));
}

TEST(ReplyJson, AnErrorReplyIsOneJsonLine) {
  EXPECT_EQ(error_line(7, "busy", "later"),
            "{\"id\":7,\"ok\":false,\"error\":{\"code\":\"busy\",\"message\":\"later\"}}\n");
  EXPECT_EQ(error_line(std::nullopt, "too_long", "x").substr(0, 10), "{\"id\":null");
}

}  // namespace
}  // namespace softgrip::daemon::reply_json_test
