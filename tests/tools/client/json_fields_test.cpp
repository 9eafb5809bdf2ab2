#include "tools/client/json_fields.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::tools::json_fields_test {
namespace {

const auto json = nlohmann::ordered_json::parse(
    R"({"text": "a\u0007b", "long": "abcdefgh", "number": 2.5, "null": null, "object": {"in": 1}})");

TEST(JsonFields, OfAnotherKindAreAsGoodAsMissing) {
  EXPECT_EQ(number_at(json, "number"), 2.5);
  for (const char* key : {"text", "null", "object", "nowhere"}) {
    EXPECT_EQ(number_at(json, key), std::nullopt) << key;
  }
  EXPECT_EQ(object_at(json, "object")["in"], 1);
  for (const char* key : {"text", "null", "number", "nowhere"})
    EXPECT_TRUE(object_at(json, key).empty()) << key;
  for (const char* key : {"number", "null", "object", "nowhere"}) EXPECT_EQ(text_at(json, key), "-") << key;
}

TEST(JsonFields, ATextIsFitForATerminal) {
  const std::string text = text_at(json, "text");
  EXPECT_EQ(text.find('\a'), std::string::npos) << text;
  EXPECT_LT(text_at(json, "long", 4).find("abc"), 2U);
  EXPECT_EQ(text_at(json, "long", 4).find("abcdefgh"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::tools::json_fields_test
