#include "base/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::json_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonMember, ReadsMembersOfTheRequestedType) {
  const Json object = Json::parse(R"({"a": 1.5, "b": true, "c": "x", "f": [1]})");
  EXPECT_EQ(json_number(object, "a"), 1.5);
  EXPECT_TRUE(json_flag(object, "b"));
  EXPECT_EQ(json_text(object, "c"), "x");
  EXPECT_EQ(json_list(object, "f").size(), 1U);
  EXPECT_EQ(json_member(object, "a"), 1.5);
}

TEST(JsonMember, MissingOrMistypedMembersGiveTheDefault) {
  const Json object = Json::parse(R"({"a": 1.5, "b": true, "c": "x", "d": null})");
  for (const char* key : {"b", "c", "d", "e"}) {
    EXPECT_NE(json_number(object, key), json_number(object, key)) << key;
    EXPECT_EQ(json_number(object, key, 3), 3) << key;
  }
  for (const char* key : {"a", "c", "d", "e"}) EXPECT_FALSE(json_flag(object, key)) << key;
  for (const char* key : {"a", "b", "d", "e"}) EXPECT_EQ(json_text(object, key), "") << key;
  for (const char* key : {"a", "b", "c", "d", "e"}) {
    EXPECT_TRUE(json_list(object, key).is_array()) << key;
    EXPECT_TRUE(json_list(object, key).empty()) << key;
  }
  EXPECT_TRUE(json_member(object, "e").is_null());
  EXPECT_TRUE(json_member(Json("no object"), "a").is_null());
}

using Json = nlohmann::ordered_json;

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(ParseJson, PreservesKeyOrderAndThirtyLevels) {
  const std::string text = R"({"b":[1,{"a":null}],"a":"x"})";
  EXPECT_EQ(parse_json<Json>(text).dump(), text);
  EXPECT_EQ(parse_json<Json>(nested(30)).dump(), nested(30));
}

TEST(JsonDump, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(json_dump(Json{{"name", "l\xf6g"}}), "{\"name\":\"l\xef\xbf\xbdg\"}");
  EXPECT_EQ(json_dump(Json{{"a", 1}}, 2), "{\n  \"a\": 1\n}");
}

TEST(ParseJson, InvalidJsonIsDiscarded) {
  for (const char* text : {"", "{", "[1,]", "{\"a\":1}}", "\xff"})
    EXPECT_TRUE(parse_json<Json>(text).is_discarded()) << text;
}

/// The reader must limit the number of nested levels. Otherwise, copying or printing deeply nested JSON would
/// overflow the stack.
TEST(ParseJson, NestingAboveTheLimitIsCutOff) {
  const Json json = parse_json<Json>(nested(1'000'000));
  const Json copy = json;  // NOLINT(performance-unnecessary-copy-initialization): the copy is the test
  EXPECT_LE(copy.dump().size(), 2U * deepest_json);
  const Json object = parse_json<Json>("{\"deep\":" + nested(1'000'000) + ",\"next\":1}");
  EXPECT_EQ(object["next"], 1);
}

}  // namespace
}  // namespace softgrip::json_test
