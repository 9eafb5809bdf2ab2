#include "document/syntax.h"

#include <gtest/gtest.h>

namespace softgrip::document::syntax_test {
namespace {

/// Returns the brackets that are still open at the end of a text. Each bracket is followed by its line and
/// column, for example "[1:5 {2:3".
std::string open_at_end(const std::string& text) {
  std::string out;
  for (const Bracket& bracket : open_brackets(text, {100, 1})) {
    out += (out.empty() ? "" : " ") + std::string(1, bracket.character) + std::to_string(bracket.at.line) +
           ":" + std::to_string(bracket.at.column);
  }
  return out;
}

TEST(Brackets, UnclosedBracketsAreReportedAsOpen) {
  EXPECT_EQ(open_at_end("a: [1, 2\nb: 3\n"), "[1:4");
  EXPECT_EQ(open_at_end("a: {b: [1, 2}\n"), "{1:4 [1:8")
      << "`}` does not close `[`, and `]` does not close `{`";
  EXPECT_EQ(open_at_end("- [1, [2], {c: 3\n"), "[1:3 {1:12");
  EXPECT_EQ(open_at_end("a: [1, 2]\nb: {c: [3]}\n"), "");
}

TEST(Brackets, BracketsInTextsQuotesAndCommentsAreIgnored) {
  EXPECT_EQ(open_at_end("about: the tip [mm and more\n"), "");
  EXPECT_EQ(open_at_end("about: \"[\" # {\nb: '['\nc: it's [\n"), "");
  EXPECT_EQ(open_at_end("about: >-\n  - [ one\n  { two\nb: [3\n"), "[4:4");
  EXPECT_EQ(open_at_end("a: [\"x\\\"[\", 'it''s ['\n"), "[1:4");
}

TEST(Brackets, OnlyBracketsBeforeTheLocationCount) {
  const std::string text = "a: [1, {b: 2}]\n";
  EXPECT_EQ(open_brackets(text, {1, 4}).size(), 0U);
  EXPECT_EQ(open_brackets(text, {1, 5}).size(), 1U);
  EXPECT_EQ(open_brackets(text, {1, 10}).size(), 2U);
  EXPECT_EQ(open_brackets(text, {1, 14}).size(), 1U);
  EXPECT_EQ(open_brackets("", {1, 1}).size(), 0U);
}

}  // namespace
}  // namespace softgrip::document::syntax_test
