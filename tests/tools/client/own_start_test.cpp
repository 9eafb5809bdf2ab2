#include "tools/client/daemon_client.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

namespace softgrip::tools::own_start_test {
namespace {

using Json = nlohmann::ordered_json;

Json failed(const Json& error) {
  return {{"id", 1}, {"ok", false}, {"error", error}};
}
Json refused(const char* name) {
  return failed({{"code", "refused"}, {"message", "m"}, {"refusal", {{"code", "R12"}, {"name", name}}}});
}

TEST(OwnStart, NoTwoStartsHaveTheSameId) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = new_start_id();
    EXPECT_EQ(id.size(), 32U);
    EXPECT_TRUE(ids.insert(id).second);
  }
}

TEST(OwnStart, AStopIsConfirmedBySuccessOrANotRunningRefusal) {
  EXPECT_EQ(stop_request_for("a"), Json::parse(R"({"command":"stop","start_id":"a"})"));
  EXPECT_TRUE(confirms_stop({{"id", 1}, {"ok", true}, {"result", {{"request", 0}}}}));
  EXPECT_TRUE(confirms_stop(refused("named_start_not_running")));
  EXPECT_FALSE(confirms_stop(refused("faulted")));
  for (const char* code : {"no_answer", "busy", "not_allowed", "bad_request", "too_many_clients"})
    EXPECT_FALSE(confirms_stop(failed({{"code", code}, {"message", "m"}}))) << code;
}

TEST(OwnStart, AMissingReplyIsNotARefusalOfTheStart) {
  EXPECT_TRUE(refuses_start(refused("not_idle")));
  for (const char* code : {"sequence_refused", "too_long"})
    EXPECT_TRUE(refuses_start(failed({{"code", code}, {"message", "m"}}))) << code;
  // The daemon may replace a client whose start it has already read.
  for (const char* code : {"no_answer", "too_many_clients"})
    EXPECT_FALSE(refuses_start(failed({{"code", code}, {"message", "m"}}))) << code;
  EXPECT_FALSE(refuses_start({{"id", 1}, {"ok", true}, {"result", {{"request", 3}}}}));
}

TEST(OwnStart, MalformedRepliesConfirmNoStopAndRefuseNoStart) {
  for (const char* reply :
       {"{}", R"({"ok":1})", R"({"ok":"true"})", R"({"ok":false,"error":7})", R"({"ok":false,"error":{}})",
        R"({"ok":false,"error":{"refusal":[]}})", R"({"ok":false,"error":{"refusal":{"name":12}}})"}) {
    EXPECT_FALSE(confirms_stop(Json::parse(reply))) << reply;
    EXPECT_FALSE(refuses_start(Json::parse(reply))) << reply;
  }
}

}  // namespace
}  // namespace softgrip::tools::own_start_test
