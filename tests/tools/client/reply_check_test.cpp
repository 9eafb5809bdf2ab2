
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/daemon_lines.h"
#include "tools/client/daemon_client.h"
#include "tools/client/daemon_text.h"
#include "tools/client/event_query.h"
#include "tools/client/live_view.h"
#include "tools/commissioning/examinations.h"

namespace softgrip::tools::reply_check_test {
namespace {

using Json = nlohmann::ordered_json;
constexpr ViewStyle style{80, false, false};

std::string error_of(const std::string& line) {
  const auto parsed = parse_reply(line);
  return parsed ? "accepted" : parsed.error();
}

/// Passes the event to each function of tools/client that reads events of the daemon.
void read_event(const Json& event) {
  LiveState state;
  static_cast<void>(line_of_event(event));
  static_cast<void>(brief_line_of_event(event));
  static_cast<void>(matches({{}, "warning", 1}, event));
  add_event(state, event);
  static_cast<void>(screen_of(state, style, 40));
  static_cast<void>(event.value("kind", "") + event.value("code", ""));
  static_cast<void>(event.value("request", std::uint64_t{0}));
}

void read_status(const Json& status) {
  LiveState state;
  update_status(state, status);
  static_cast<void>(screen_of(state, style, 40));
  static_cast<void>(view_of(status, style));
  static_cast<void>(line_of_status(status));
  doctor::Findings findings;
  doctor::examine_daemon(status, status, "rig", findings);
}

void read(const Json& line) {
  if (line.contains("watch")) return read_status(line["watch"]);
  if (line.contains("event")) return read_event(line["event"]);
  static_cast<void>(confirms_stop(line));
  static_cast<void>(refuses_start(line));
  const auto result = DaemonClient::result_of(line);
  if (!result) return;
  read_status(*result);
  static_cast<void>(result->value("newest", std::uint64_t{0}));
  static_cast<void>(result->value("request", std::uint64_t{0}));
  static_cast<void>(sentence_of_acknowledged(*result));
  static_cast<void>(problem_list(result->value("warnings", Json::array())));
  for (const Json& event : result->value("events", Json::array())) read_event(event);
  static_cast<void>(view_of_sequences(result->value("sequences", Json::array())));
  static_cast<void>(names_of_sequences(result->value("sequences", Json::array())));
}

TEST(ReplyCheck, AcceptsEveryKindOfReplyAndAdditionalKeys) {
  for (const Json& line : testing::good_lines()) {
    const auto parsed = parse_reply(line.dump());
    ASSERT_TRUE(parsed) << parsed.error() << "\n" << line;
    EXPECT_EQ(*parsed, line);
  }
  // A newer daemon may send additional keys, so the check must accept them.
  EXPECT_TRUE(parse_reply(R"({"id": 1, "ok": true, "more": [], "result": {"more": {"state": 3}}})"));
}

TEST(ReplyCheck, ErrorNamesTheMalformedKey) {
  EXPECT_EQ(error_of("{}"), "`ok` is missing");
  EXPECT_EQ(error_of("[]"), "a line is not a JSON object");
  EXPECT_EQ(error_of(R"({"ok":1})"), "`ok` has the wrong type");
  EXPECT_EQ(error_of(R"({"ok":true})"), "`result` is missing");
  EXPECT_EQ(error_of(R"({"ok":false,"error":{"code":"busy"}})"), "`error.message` is missing");
  EXPECT_EQ(error_of(R"({"ok":true,"result":{"events":[{},3]}})"), "`result.events[1]` has the wrong type");
  EXPECT_EQ(error_of(R"({"id":-1,"ok":true,"result":{}})"), "`id` has the wrong type");
  EXPECT_EQ(error_of(R"({"watch":{}})"), "`watch.state` is missing");
  EXPECT_EQ(error_of(""), "a line is not JSON in UTF-8");
  EXPECT_EQ(error_of("{\"ok\":true,\"result\":{\"a\":\"\xff\xfe\"}}"), "a line is not JSON in UTF-8");
  EXPECT_EQ(error_of(R"({"ok":true,"result":{"request":1e999}})"), "a line is not JSON in UTF-8");
}

TEST(ReplyCheck, RefusesMoreThan32NestingLevelsBeforeParsing) {
  const auto nested = [](std::size_t depth) {
    return R"({"ok":true,"result":{"a":)" + std::string(depth, '[') + std::string(depth, ']') + "}}";
  };
  EXPECT_TRUE(parse_reply(nested(30)));
  EXPECT_EQ(error_of(nested(31)), "a line nests deeper than 32 levels");
  EXPECT_EQ(error_of(std::string(8'000'000, '[')), "a line nests deeper than 32 levels");
  const std::string brackets(100, '[');
  EXPECT_TRUE(parse_reply(R"({"ok":true,"result":{"a":"\"\\)" + brackets + R"("}})"))
      << "brackets inside a string are text";
}

/// In a line of each kind, removes each value or replaces it by values of all JSON types. Either the check
/// must refuse the changed line, or each function that reads this kind of line must accept it.
TEST(ReplyCheck, EveryAcceptedReplyIsReadWithoutException) {
  std::size_t refused = 0;
  std::size_t passed = 0;
  for (const Json& good : testing::good_lines()) {
    for (const Json& bad : testing::damaged(good)) {
      const auto parsed = parse_reply(bad.dump());
      ++(parsed ? passed : refused);
      if (parsed) {
        EXPECT_NO_THROW(read(*parsed)) << bad;
      }
    }
  }
  EXPECT_GT(refused, 1000U);
  EXPECT_GT(passed, 500U);
}

const auto json = nlohmann::ordered_json::parse(
    R"({"text": "a\u0007b", "long": "abcdefgh", "number": 2.5, "null": null, "object": {"in": 1}})");

TEST(JsonFields, AFieldOfAnotherTypeIsReadAsMissing) {
  EXPECT_EQ(number_at(json, "number"), 2.5);
  for (const char* key : {"text", "null", "object", "nowhere"}) {
    EXPECT_EQ(number_at(json, key), std::nullopt) << key;
  }
  EXPECT_EQ(object_at(json, "object")["in"], 1);
  for (const char* key : {"text", "null", "number", "nowhere"})
    EXPECT_TRUE(object_at(json, key).empty()) << key;
  for (const char* key : {"number", "null", "object", "nowhere"}) EXPECT_EQ(text_at(json, key), "-") << key;
}

TEST(JsonFields, TextIsShortenedAndHasNoControlCharacters) {
  const std::string text = text_at(json, "text");
  EXPECT_EQ(text.find('\a'), std::string::npos) << text;
  EXPECT_LT(text_at(json, "long", 4).find("abc"), 2U);
  EXPECT_EQ(text_at(json, "long", 4).find("abcdefgh"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::tools::reply_check_test
