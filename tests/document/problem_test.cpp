// Tests the message that the user sees for a problem.

#include "document/problem.h"

#include <gtest/gtest.h>

#include "document/node.h"

namespace softgrip::document::problem_test {
namespace {

Problem problem_at(int line, int column, std::string text) {
  return {"a.yaml", {line, column}, std::move(text), "wrong", ""};
}

TEST(Problems, AMessageShowsLocationLineCaretAndHint) {
  Problems problems;
  problems.add({"rig.yaml", {12, 5}, "    delay_ms: 130", "unknown key `delay_ms`", "write `delay_s`"});
  EXPECT_EQ(problems.format(),
            "rig.yaml:12:5: unknown key `delay_ms`\n"
            "        delay_ms: 130\n"
            "        ^\n"
            "    hint: write `delay_s`\n");
}

TEST(Problem, IsLocatedByFileLineAndColumn) {
  EXPECT_EQ(text_of(Location{12, 5}), "12:5");
  EXPECT_EQ(place_of(problem_at(12, 5, "")), "a.yaml:12:5");
}

TEST(Problems, WithoutProblemsTheTextIsEmpty) {
  EXPECT_EQ(Problems().format(), "");
}

TEST(Problems, AProblemWithoutAQuotedLineIsOneLine) {
  Problems problems;
  problems.add({"rig.yaml", {1, 1}, "", "the file cannot be read", ""});
  EXPECT_EQ(problems.format(), "rig.yaml:1:1: the file cannot be read\n");
}

TEST(Problems, AreGroupedByFileAndSortedByLine) {
  Problems problems;
  problems.add({"b.yaml", {9, 1}, "", "nine", ""});
  problems.add({"a.yaml", {2, 1}, "", "two", ""});
  problems.add({"b.yaml", {3, 7}, "", "three seven", ""});
  problems.add({"b.yaml", {3, 2}, "", "three two", ""});
  problems.warn({"b.yaml", {5, 1}, "", "five", ""});
  EXPECT_EQ(problems.format(),
            "b.yaml:3:2: three two\nb.yaml:3:7: three seven\nb.yaml:5:1: warning: five\nb.yaml:9:1: nine\n"
            "a.yaml:2:1: two\n");
  EXPECT_EQ(problems.list().front().message, "nine");
}

TEST(Problems, WarningsAreNotCountedAsProblems) {
  Problems problems;
  problems.warn(problem_at(1, 1, "a"));
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(problems.size(), 0U);
  EXPECT_EQ(problems.warnings().size(), 1U);
}

TEST(Problems, OnlyTheFirstAreKeptAndTheRestIsCounted) {
  Problems problems;
  for (std::size_t i = 0; i < Problems::most + 7; ++i) problems.add({"a", {1, 1}, "", std::to_string(i), ""});
  EXPECT_EQ(problems.list().size(), Problems::most);
  EXPECT_EQ(problems.size(), Problems::most + 7);
  EXPECT_TRUE(problems.full());
  EXPECT_NE(problems.format().find("and 7 more\n"), std::string::npos);
  EXPECT_EQ(problems.without_repeats().size(), Problems::most + 7);
}

TEST(Problems, WithoutRepeatsRemovesRepetitions) {
  Problems problems;
  problems.add(problem_at(1, 1, "a"));
  problems.add(problem_at(2, 1, "b"));
  problems.add(problem_at(1, 1, "a"));
  EXPECT_EQ(problems.without_repeats().size(), 2U);
}

/// Returns two lines of the message for a problem. The first line quotes the file, and the second line
/// contains the caret.
std::pair<std::string, std::string> shown_line(const Problem& problem) {
  Problems problems;
  problems.add(problem);
  const std::string text = problems.format();
  const std::size_t first = text.find('\n') + 1;
  const std::size_t second = text.find('\n', first) + 1;
  return {text.substr(first, second - first - 1), text.substr(second, text.find('\n', second) - second)};
}

TEST(Problems, TheCaretIsBelowTheCharacterOfTheColumn) {
  const auto [line, caret] = shown_line(problem_at(1, 10, "größe: 1"));
  EXPECT_EQ(line, "    größe: 1");
  EXPECT_EQ(caret,
            "           ^");  // columns count bytes; the 7 characters before column 10 have 9 bytes
  const auto [tabbed, below] = shown_line(problem_at(1, 3, "\ta: \x1b[1m"));
  EXPECT_EQ(tabbed, "    \\ta: \\x1b[1m");
  EXPECT_EQ(below, "       ^");
}

TEST(Problems, LongLinesAreShownAroundTheColumn) {
  std::string line(300, 'x');
  line[199] = 'Y';
  const auto [shown, caret] = shown_line(problem_at(1, 200, line));
  EXPECT_LT(shown.size(), 120U);
  EXPECT_TRUE(shown.starts_with("    ...x"));
  EXPECT_TRUE(shown.ends_with("x..."));
  EXPECT_EQ(shown[caret.size() - 1], 'Y');
}

TEST(Problems, EveryColumnOfAnyLineCanBeShown) {
  const std::string bytes = "a\xc3\xa4\xe2\x82\xac\xf0\x9f\x99\x82\xff\x80\t ";
  for (std::size_t length = 0; length < 260; ++length) {
    std::string line;
    while (line.size() < length) line += bytes[line.size() % bytes.size()];
    for (int column = -1; column < 270; column += 7) {
      Problems problems;
      problems.add(problem_at(1, column, line));
      EXPECT_FALSE(problems.format().empty());
    }
  }
}

TEST(Shown, ControlCharactersAreVisible) {
  EXPECT_EQ(shown("a\nb\t\r\x01\x7f\xc2\x9b\xff"
                  "ä"),
            "a\\nb\\t\\r\\x01\\x7f\\xc2\\x9b\\xffä");
  EXPECT_EQ(shown(std::string(100, 'x'), 10), "xxxxxxxxxx...");
}

TEST(Nearest, SuggestsAKeyForSmallTypingErrorsOnly) {
  const std::vector<std::string> keys{"pressure_min_kpa", "pressure_max_kpa", "name", "rate_hz"};
  EXPECT_EQ(nearest("presure_max_kpa", keys), "pressure_max_kpa");
  EXPECT_EQ(nearest("nmae", keys), "");  // two of four letters are wrong, so no key is suggested
  EXPECT_EQ(nearest("nam", keys), "name");
  EXPECT_EQ(nearest("rate_hertz", keys), "rate_hz");
  EXPECT_EQ(nearest("temperature", keys), "");
  EXPECT_EQ(nearest("x", {"y"}), "");
  EXPECT_EQ(nearest("", {"y"}), "");
}

}  // namespace
}  // namespace softgrip::document::problem_test
