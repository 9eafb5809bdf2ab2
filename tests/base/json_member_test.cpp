#include "base/json_member.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::json_member_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonMember, ReadsMembersOfTheirType) {
  const Json object = Json::parse(R"({"a": 1.5, "b": true, "c": "x", "f": [1]})");
  EXPECT_EQ(json_number(object, "a"), 1.5);
  EXPECT_TRUE(json_flag(object, "b"));
  EXPECT_EQ(json_text(object, "c"), "x");
  EXPECT_EQ(json_list(object, "f").size(), 1U);
  EXPECT_EQ(json_member(object, "a"), 1.5);
}

TEST(JsonMember, WhatIsMissingOrOfAnotherTypeIsNotKnown) {
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

}  // namespace
}  // namespace softgrip::json_member_test
