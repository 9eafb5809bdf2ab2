#include "base/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace softgrip::json_text_test {
namespace {

using Json = nlohmann::ordered_json;

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(ParseJson, KeepsOrdinaryTexts) {
  const std::string text = R"({"b":[1,{"a":null}],"a":"x"})";
  EXPECT_EQ(parse_json<Json>(text).dump(), text);
  EXPECT_EQ(parse_json<Json>(nested(30)).dump(), nested(30));
}

TEST(ParseJson, WhatIsNotJsonIsDiscarded) {
  for (const char* text : {"", "{", "[1,]", "{\"a\":1}}", "\xff"})
    EXPECT_TRUE(parse_json<Json>(text).is_discarded()) << text;
}

/// The reader must limit the number of nested levels. Otherwise, copying or printing deeply nested JSON would
/// overflow the stack.
TEST(ParseJson, ManyLevelsAreCutOff) {
  const Json json = parse_json<Json>(nested(1'000'000));
  const Json copy = json;  // NOLINT(performance-unnecessary-copy-initialization): the copy is the test
  EXPECT_LE(copy.dump().size(), 2U * deepest_json);
  const Json object = parse_json<Json>("{\"deep\":" + nested(1'000'000) + ",\"next\":1}");
  EXPECT_EQ(object["next"], 1);
}

}  // namespace
}  // namespace softgrip::json_text_test
