// Tests every getter of MapReader with every type of mistake. One reading must report all mistakes of a
// document.

#include "document/reader.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/document/problems_of.h"

namespace softgrip::document::reader_test {
namespace {

using Use = std::function<void(MapReader&)>;

/// Reads `text` with the function `use`. Returns the problems, each as "line:column: message hint".
Lines reported(const std::string& text, const Use& use) {
  Problems problems;
  const Document document = parse("test.yaml", text, problems);
  {
    MapReader reader(document, document.root, problems, "the map");
    use(reader);
  }
  Lines lines = lines_of(problems);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!problems.list()[i].hint.empty()) lines[i] += " | " + problems.list()[i].hint;
  }
  return lines;
}

void use_delay(MapReader& reader) {
  reader.number("delay_s", {0, 10});
}

TEST(Reader, ReadsAValueUnderItsDeprecatedName) {
  const auto use = [](MapReader& reader) {
    EXPECT_EQ(reader.integer(reader.name_in_use("new", "old"), {0, 9}), reader.keys().empty() ? 0 : 7);
  };
  EXPECT_EQ(reported("new: 7\n", use), Lines{});
  EXPECT_EQ(reported("old: 7\n", use), Lines{});
  EXPECT_EQ(
      reported("new: 7\nold: 3\n", use),
      Lines{"2:1: `old` is the deprecated name of `new`, but the map contains both keys | remove `old`"});
  EXPECT_EQ(reported("{}\n", use), Lines{"1:1: the map lacks the key `new`"});
}

TEST(Reader, ReadsEveryTypeOfValue) {
  const Lines lines = reported("n: 0.5\ni: -3\nb: true\nt: hello\nc: two\nl: [1, 2]\nm: {k: 1}\ns: [x]\n",
                               [](MapReader& reader) {
                                 EXPECT_EQ(reader.number("n", {}), 0.5);
                                 EXPECT_EQ(reader.integer("i", {-5, 5}), -3);
                                 EXPECT_TRUE(reader.boolean("b"));
                                 EXPECT_EQ(reader.text("t"), "hello");
                                 EXPECT_EQ(reader.choice("c", {"one", "two"}), 1U);
                                 EXPECT_EQ(reader.numbers("l", 2, {0, 9}), (std::vector<double>{1, 2}));
                                 EXPECT_EQ(reader.child("m", true)->entries.size(), 1U);
                                 EXPECT_EQ(reader.sequence("s", true).size(), 1U);
                                 EXPECT_EQ(reader.optional_number("absent", {}), std::nullopt);
                                 EXPECT_EQ(reader.optional_integer("absent", {0, 1}), std::nullopt);
                                 EXPECT_EQ(reader.optional_boolean("absent"), std::nullopt);
                                 EXPECT_EQ(reader.optional_text("absent"), std::nullopt);
                                 EXPECT_EQ(reader.optional_choice("absent", {"a"}), std::nullopt);
                                 EXPECT_EQ(reader.optional_numbers("absent", 2, {}), std::nullopt);
                                 EXPECT_EQ(reader.child("absent", false), nullptr);
                                 EXPECT_TRUE(reader.sequence("absent", false).empty());
                                 EXPECT_EQ(reader.where("b"), (Location{3, 1}));
                                 EXPECT_EQ(reader.keys().size(), 8U);
                               });
  EXPECT_EQ(lines, Lines{});
}

TEST(Reader, AMissingUnitIsRecognised) {
  EXPECT_EQ(reported("delay: 0.1\n", use_delay),
            (Lines{"1:1: unknown key `delay` in the map | the unit is missing: did you mean `delay_s`?"}));
}

TEST(Reader, ADifferentUnitIsConvertedInTheHint) {
  EXPECT_EQ(reported("delay_ms: 130\n", use_delay),
            (Lines{"1:1: unknown key `delay_ms` in the map | unit `ms` is not used here: write `delay_s` in "
                   "seconds (130 ms = 0.13)"}));
  EXPECT_EQ(reported("pressure_bar: 0.6\n",
                     [](MapReader& r) {
                       r.number("pressure_kpa", {0, 100});
                     }),
            (Lines{"1:1: unknown key `pressure_bar` in the map | unit `bar` is not used here: write "
                   "`pressure_kpa` in kilopascals (0.6 bar = 60)"}));
  EXPECT_EQ(reported("slew_bar_per_s: 3\n",
                     [](MapReader& r) {
                       r.number("slew_kpa_per_s", {0, 1e4});
                     }),
            (Lines{"1:1: unknown key `slew_bar_per_s` in the map | unit `bar` is not used here: write "
                   "`slew_kpa_per_s`"}));
  EXPECT_EQ(reported("delay_kpa: 3\n", use_delay),
            (Lines{"1:1: unknown key `delay_kpa` in the map | did you mean `delay_s`?"}));
}

TEST(Reader, AMisspeltKeyIsOneProblemNotTwo) {
  EXPECT_EQ(reported("dealy_s: 0.1\n", use_delay),
            (Lines{"1:1: unknown key `dealy_s` in the map | did you mean `delay_s`?"}));
}

TEST(Reader, APresentKeyIsNotSuggested) {
  EXPECT_EQ(reported("delay_s: 0.1\ndelay_ms: 130\n", use_delay),
            (Lines{"2:1: unknown key `delay_ms` in the map | known here: `delay_s`"}));
}

TEST(Reader, AMissingSpaceAfterTheColonIsRecognised) {
  EXPECT_EQ(reported("{delay_s:0.1}\n", use_delay),
            (Lines{"1:2: unknown key `delay_s:0.1` in the map | a space is missing after the colon"}));
  EXPECT_EQ(reported("delay_s:0.1\n", use_delay),
            (Lines{"1:1: the map must be a map of keys, found `delay_s:0.1` | a space is missing after the "
                   "colon"}));
}

TEST(Reader, AMissingKeyIsReportedAtTheMap) {
  EXPECT_EQ(reported("other: 1\n",
                     [](MapReader& r) {
                       r.number("other", {});
                       use_delay(r);
                     }),
            (Lines{"1:1: the map lacks the key `delay_s`"}));
}

TEST(Reader, AValueOutOfRangeIsReportedAndClamped) {
  EXPECT_EQ(reported("delay_s: 130\n",
                     [](MapReader& r) {
                       EXPECT_EQ(r.number("delay_s", {0, 1}), 1.0);
                     }),
            (Lines{"1:10: `delay_s` is 130, allowed is 0 to 1 | the unit is seconds: 130 ms would be 0.13"}));
  EXPECT_EQ(reported("k: -1\n", [](MapReader& r) { EXPECT_EQ(r.number("k", Range{0.5}), 0.5); }),
            (Lines{"1:4: `k` is -1, allowed is at least 0.5"}));
  EXPECT_EQ(reported("i: 7\n",
                     [](MapReader& r) {
                       EXPECT_EQ(r.integer("i", {1, 3}), 3);
                     }),
            (Lines{"1:4: `i` is 7, allowed is 1 to 3"}));
  EXPECT_EQ(reported("k: 1\n", [](MapReader& r) { EXPECT_EQ(r.number("k", {1, 1}), 1.0); }), Lines{});
}

TEST(Reader, WrongTypesAreNamedInTheMessage) {
  const Lines lines =
      reported("n: [1]\ni: {a: 1}\nb: yes\nt:\nc: tow\nl: [1, x]\ns: 1\nm: 2\n", [](MapReader& r) {
        r.number("n", {1, 2});
        r.integer("i", {0, 9});
        r.boolean("b");
        r.text("t");
        r.choice("c", {"one", "two", "three"});
        r.numbers("l", 2, {});
        r.sequence("s", true);
        r.child("m", true);
      });
  EXPECT_EQ(
      lines,
      (Lines{"1:4: `n` must be a number, found a list", "2:4: `i` must be a whole number, found a map",
             "3:4: `b` must be `true` or `false`, found `yes` | write `true`",
             "4:2: `t` must be a text, found nothing",
             "5:4: `c` must be `one`, `two` or `three`, found `tow`", "6:8: `l` must be a number, found `x`",
             "7:4: `s` must be a list, found `1` | put `- ` before each item"}));
}

TEST(Reader, ListsMustHaveTheRequiredLength) {
  EXPECT_EQ(reported("l: [1, 2, 3]\n",
                     [](MapReader& r) {
                       EXPECT_EQ(r.numbers("l", 2, {}), (std::vector<double>{1, 2}));
                     }),
            (Lines{"1:4: `l` must be a list of 2 numbers, found 3"}));
  EXPECT_EQ(reported("l: 5\n",
                     [](MapReader& r) {
                       EXPECT_EQ(r.numbers("l", 2, {1, 9}).size(), 2U);
                     }),
            (Lines{"1:4: `l` must be a list of 2 numbers, found `5`"}));
}

TEST(Reader, TextsMustBeOnePrintableLine) {
  EXPECT_EQ(reported("t: \"a\\nb\"\n", [](MapReader& r) { EXPECT_EQ(r.text("t"), ""); }),
            (Lines{"1:4: `t` must be one line without control characters, found `a\\nb` | start a text of "
                   "several lines with `>-`"}));
  EXPECT_EQ(reported("t: >-\n  a\n  b\n", [](MapReader& r) { EXPECT_EQ(r.text("t"), "a b"); }), Lines{});
  EXPECT_EQ(reported("t: \"\\x9b31m\"\n", [](MapReader& r) { r.text("t"); }).size(), 1U);
}

TEST(Reader, AValueThatIsNotAMapIsReportedOnce) {
  EXPECT_EQ(
      reported("- a\n", use_delay),
      (Lines{"1:1: the map must be a map of keys, found a list | remove the `- ` or `[ ]` if there is only "
             "one item"}));
  EXPECT_EQ(reported("", use_delay), (Lines{"1:1: the map must be a map of keys, found nothing"}));
}

TEST(Reader, ARefusedAliasIsNotReportedAgain) {
  EXPECT_EQ(reported("delay_s: *x\n", use_delay).size(), 1U);
  EXPECT_EQ(reported("a: &x 1\ndelay_s: *x\n",
                     [](MapReader& r) {
                       r.number("a", {});
                       use_delay(r);
                     })
                .size(),
            2U);
}

TEST(Reader, AnIncompleteDocumentReportsNoMissingKeys) {
  EXPECT_EQ(reported("a: 1\nb: [\n",
                     [](MapReader& r) {
                       r.text("a");
                       r.numbers("b", 2, {});
                       use_delay(r);
                     })
                .size(),
            1U);
}

TEST(Reader, AValueJoinedByASyntaxErrorIsNotReported) {
  // The value of `delay_s` ends at the second colon, so the YAML parser returns the value "1 name".
  EXPECT_EQ(reported("delay_s: 1\n  name: x\n", use_delay).size(), 1U);
}

TEST(Reader, GoodIsTrueOnlyForValidKeys) {
  reported("a: 1\nb: x\nc: *d\ne: 2\n", [](MapReader& r) {
    for (const char* const key : {"a", "b", "c", "d", "e"}) r.optional_number(key, {});
    EXPECT_TRUE(r.good("a"));
    EXPECT_FALSE(r.good("b"));
    EXPECT_FALSE(r.good("c"));
    EXPECT_FALSE(r.good("d"));
    r.report("e", "no");
    EXPECT_FALSE(r.good("e"));
  });
}

TEST(Reader, WarningsAndReportsHaveTheLocationOfTheValue) {
  Problems problems;
  const Document document = parse("a.yaml", "first: 1\nsecond: 2\n", problems);
  MapReader reader(document, document.root, problems, "m");
  reader.number("first", {});
  reader.report("first", "no");
  reader.warn("second", "careful");
  reader.finish();
  reader.finish();
  EXPECT_EQ(lines_of(problems), (Lines{"1:8: no"}));
  EXPECT_EQ(problems.warnings().front().at, (Location{2, 9}));
}

TEST(Reader, EveryMistakeOfAFileIsFoundInOnePass) {
  const Lines lines =
      reported("delay_ms: 1\nrate_hz: .nan\nname: [x]\nextra: 1\nname: y\n", [](MapReader& r) {
        use_delay(r);
        r.number("rate_hz", {1, 1000});
        r.text("name");
        r.text("source");
      });
  EXPECT_EQ(lines.size(), 6U) << ::testing::PrintToString(lines);
}

TEST(NumberIn, ReadsItemsOfLists) {
  Problems problems;
  const Document document = parse("a.yaml", "[1, two, 30]\n", problems);
  EXPECT_EQ(number_in(document, document.root.items[0], {0, 9}, problems, "the item"), 1.0);
  EXPECT_EQ(number_in(document, document.root.items[1], {0, 9}, problems, "the item"), std::nullopt);
  EXPECT_EQ(number_in(document, document.root.items[2], {0, 9}, problems, "the item"), std::nullopt);
  EXPECT_EQ(lines_of(problems), (Lines{"1:5: the item must be a number, found `two`",
                                       "1:10: the item is 30, allowed is 0 to 9"}));
}

}  // namespace
}  // namespace softgrip::document::reader_test
