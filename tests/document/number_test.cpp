// Tests the conversion of texts to numbers. The conversion must be exact and independent of the locale. If a
// text is not a number, the message must give a hint.

#include "base/numbers.h"
#include "document/node.h"

#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <random>

namespace softgrip::document::number_test {
namespace {

Node plain(std::string text) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.scalar = std::move(text);
  return node;
}

struct Refused {
  std::string text;
  std::string hint;
};

TEST(Number, FiniteDoublesAreWrittenAndReadExactly) {
  constexpr std::uint64_t seed = 20'240'611;
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 random(seed);
  for (int i = 0; i < 200'000; ++i) {
    const double number = std::bit_cast<double>(random());
    if (!std::isfinite(number)) continue;
    const auto parsed = parse_number(plain(written(number)));
    ASSERT_TRUE(parsed.value) << written(number) << " seed " << seed;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*parsed.value), std::bit_cast<std::uint64_t>(number))
        << written(number);
  }
}

TEST(Number, AcceptsPlainDecimals) {
  EXPECT_EQ(parse_number(plain("0.13")).value, 0.13);
  EXPECT_EQ(parse_number(plain("-12")).value, -12.0);
  EXPECT_EQ(parse_number(plain("+5")).value, 5.0);
  EXPECT_EQ(parse_number(plain(".5")).value, 0.5);
  EXPECT_EQ(parse_number(plain("5.")).value, 5.0);
  EXPECT_EQ(parse_number(plain("3.6e6")).value, 3.6e6);
  EXPECT_EQ(parse_number(plain("1E-3")).value, 1e-3);
  EXPECT_EQ(parse_number(plain("0")).value, 0.0);
  EXPECT_TRUE(std::signbit(*parse_number(plain("-0")).value));
}

TEST(Number, RefusesOtherNotationsWithAMessage) {
  const std::vector<Refused> refused{
      {".nan", "only finite numbers are allowed"},
      {".inf", "only finite numbers are allowed"},
      {"-.Inf", "only finite numbers are allowed"},
      {"nan", "only finite numbers are allowed"},
      {"infinity", "only finite numbers are allowed"},
      {"0x1F", "write the number in decimal"},
      {"0o17", "write the number in decimal"},
      {"017", "a number with a leading zero could be read as octal: remove the zero"},
      {"1_000", "write 1000"},
      {"0,13", "the decimal mark is a point: 0.13"},
      {"130 ms", "write the number without a unit, because the key contains the unit"},
      {"60kPa", "write the number without a unit, because the key contains the unit"},
      {"yes", "a number is needed here, not a boolean"},
      {"Off", "a number is needed here, not a boolean"},
      {"fast", ""},
      {"1e", "write the number without a unit, because the key contains the unit"},
      {"--1", ""},
      {"+-1", ""},
      {"-+1", ""},
      {"1 2", ""},
      {"e5", ""},
      {".", ""},
      {"-", ""},
      {"1:30", ""},
  };
  for (const Refused& example : refused) {
    const auto parsed = parse_number(plain(example.text));
    EXPECT_FALSE(parsed.value) << example.text;
    EXPECT_FALSE(parsed.message.empty()) << example.text;
    EXPECT_EQ(parsed.hint, example.hint) << example.text;
  }
}

TEST(Number, ValuesOutsideTheDoubleRangeAreRefused) {
  EXPECT_EQ(parse_number(plain("1e999")).message, "is `1e999`, too large or too close to zero for a number");
  EXPECT_FALSE(parse_number(plain("1e-999")).value);
  EXPECT_TRUE(parse_number(plain("0e-999")).value);
}

TEST(Number, QuotedNumbersAreTexts) {
  Node node = plain("0.13");
  node.quoted = true;
  const auto parsed = parse_number(node);
  EXPECT_EQ(parsed.message, "must be a number, found the text `0.13` in quotes");
  EXPECT_EQ(parsed.hint, "remove the quotes");
}

TEST(Number, ParsingIsIndependentOfTheLocale) {
  const char* const old = std::setlocale(LC_ALL, nullptr);
  const std::string before = old == nullptr ? "C" : old;
  for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    EXPECT_EQ(parse_number(plain("0.5")).value, 0.5) << name;
    EXPECT_EQ(written(0.5), "0.5") << name;
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Integer, MustBeAWholeDecimalWithin64Bits) {
  EXPECT_EQ(parse_integer(plain("-9223372036854775808")).value, std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(parse_integer(plain("9223372036854775807")).value, std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(parse_integer(plain("9223372036854775808")).message,
            "is `9223372036854775808`, too large for a whole number");
  EXPECT_EQ(parse_integer(plain("1.0")).hint, "write the number without decimal point and without exponent");
  EXPECT_EQ(parse_integer(plain("1e3")).hint, "write the number without decimal point and without exponent");
  EXPECT_FALSE(parse_integer(plain("0x10")).value);
  EXPECT_FALSE(parse_integer(plain("010")).value);
  EXPECT_EQ(parse_integer(plain("1_000")).hint, "write 1000");
}

TEST(Boolean, AcceptsOnlyTrueAndFalse) {
  EXPECT_EQ(parse_boolean(plain("true")).value, true);
  EXPECT_EQ(parse_boolean(plain("false")).value, false);
  for (const char* const text : {"yes", "Yes", "on", "TRUE", "True", "y", "1"}) {
    EXPECT_FALSE(parse_boolean(plain(text)).value) << text;
    EXPECT_EQ(parse_boolean(plain(text)).hint, "write `true`") << text;
  }
  for (const char* const text : {"no", "off", "False", "n", "0"}) {
    EXPECT_EQ(parse_boolean(plain(text)).hint, "write `false`") << text;
  }
  EXPECT_FALSE(parse_boolean(plain("maybe")).value);
}

}  // namespace
}  // namespace softgrip::document::number_test
