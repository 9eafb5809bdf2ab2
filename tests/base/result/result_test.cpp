#include "base/result/result.h"

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

namespace softgrip::result::result_test {
namespace {

struct Grip {
  std::string name;
  double error_mm = 0;
  bool healthy = false;
};

Fields fields_of(const Grip& run) {
  return {{"run", "run", run.name},
          {"error_mm", "error", number(run.error_mm, 2, "mm")},
          {"healthy", run.healthy},
          {"", "state", run.healthy ? "healthy" : "later"}};
}

TEST(Result, JsonContainsTheKeyedFieldsInOrder) {
  const Fields fields{
      {"z", 1}, {"", "only for readers", 2}, {"a", "titled", true}, {"list", Value::List{1, "b"}}};
  EXPECT_EQ(json_of(fields).dump(), R"({"z":1,"a":true,"list":[1,"b"]})");
  EXPECT_EQ(json_text({{"a", Fields{{"b", 1.0}}}}), "{\n  \"a\": {\n    \"b\": 1.0\n  }\n}\n");
  EXPECT_EQ(json_of(Fields()).dump(), "{}");
  EXPECT_EQ(json_of(Value::List()).dump(), "[]");
}

TEST(Result, NonFiniteAndMissingNumbersAreNullInJson) {
  for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(json_of(none).is_null());
    EXPECT_EQ(number(none, 3, "mm").text, "-");
    EXPECT_EQ(decimals(none, 1).text, "-");
  }
  EXPECT_TRUE(json_of(number(std::nullopt)).is_null());
  EXPECT_EQ(number(std::nullopt, 4, "mm").text, "-");
  EXPECT_TRUE(json_of(Value()).is_null());
  EXPECT_TRUE(json_of(or_null("")).is_null());
  EXPECT_EQ(or_null("").text, "");
  EXPECT_TRUE(json_of(or_null(std::optional<Grip>(), fields_of)).is_null());
  EXPECT_EQ(json_of(or_null(std::optional(Grip{"a", 1, true}), fields_of))["run"], "a");
  EXPECT_EQ(json_of(or_null("why")), "why");
}

TEST(Result, JsonKeepsEveryDigitAndTheTextRounds) {
  const Value value = number(0.123456789, 2, "mm");
  EXPECT_EQ(json_of(value).dump(), "0.123456789");
  EXPECT_EQ(value.text, "0.12 mm");
  EXPECT_EQ(decimals(2.0 / 3, 1).text, "0.7");
  EXPECT_EQ(json_of(decimals(2.0 / 3, 1)), 2.0 / 3);
  EXPECT_EQ(json_of(shown(0.5, "half")).dump(), "0.5");
}

TEST(Result, InvalidUtf8IsReplacedInJson) {
  EXPECT_EQ(json_text({{"path", "a\xff"}}), "{\n  \"path\": \"a\xef\xbf\xbd\"\n}\n");
}

TEST(Result, ATableHasAColumnForEachTitle) {
  const Table table =
      table_of("Errors", std::vector<Grip>{{"a", 0.123, true}, {"long name", 12, false}}, fields_of);
  EXPECT_EQ(text_of(table),
            "Errors\n"
            "  run          error  state\n"
            "  a          0.12 mm  healthy\n"
            "  long name    12 mm  later\n");
  EXPECT_EQ(table.numeric, (std::vector<bool>{false, true, false}));
}

TEST(Result, ATableWithoutRowsHasItsColumns) {
  const Table table = table_of("Errors", std::vector<Grip>{}, fields_of);
  EXPECT_EQ(table.header, (std::vector<std::string>{"run", "error", "state"}));
  EXPECT_EQ(table.numeric, (std::vector<bool>{false, true, false}));
  EXPECT_TRUE(table.rows.empty());
}

TEST(Result, MissingNumbersAreAlignedLikeNumbers) {
  EXPECT_TRUE(number(std::nullopt).numeric);
  EXPECT_TRUE(Value(3).numeric);
  EXPECT_FALSE(shown(3, "three").numeric);
  EXPECT_TRUE(shown("0.1 / 0.2", "0.1 / 0.2", true).numeric);
  EXPECT_FALSE(Value("3").numeric);
}

TEST(Result, TermsAreTheTitlesAndTheTexts) {
  EXPECT_EQ(terms_of(fields_of({"a", 2, true})),
            (Terms{{"run", "a"}, {"error", "2 mm"}, {"state", "healthy"}}));
}

TEST(Result, TermsOfAnObjectWithoutATitleStandInItsPlace) {
  const Fields inner{{"b", "second", 2}, {"c", 3}};
  EXPECT_EQ(terms_of({{"a", "first", 1}, {"inner", inner}, {"d", "object", shown(inner, "one")}}),
            (Terms{{"first", "1"}, {"second", "2"}, {"object", "one"}}));
}

TEST(Result, ALaterFieldReplacesTheValueOfItsKey) {
  EXPECT_EQ(json_of(Fields{{"a", Value()}, {"b", 2}, {"a", 1}}).dump(), R"({"a":1,"b":2})");
}

TEST(Result, ContainersAreConvertedToListsAndObjects) {
  EXPECT_EQ(json_of(list_of(std::vector<Grip>{{"a", 1, true}}, fields_of)).dump(),
            R"([{"run":"a","error_mm":1.0,"healthy":true}])");
  EXPECT_EQ(json_of(keyed(std::map<std::string, double>{{"b", 2}, {"a", 1}})).dump(), R"({"a":1.0,"b":2.0})");
  const std::vector<std::string> ids{"x", "y"};
  EXPECT_EQ(json_of(ids).dump(), R"(["x","y"])");
  EXPECT_EQ(Value(ids).text, "x, y");
  EXPECT_EQ(Value(std::vector<std::string>()).text, "-");
}

}  // namespace
}  // namespace softgrip::result::result_test
