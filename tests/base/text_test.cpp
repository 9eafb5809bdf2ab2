#include "base/text.h"

#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip::text_test {
namespace {

using Words = std::vector<std::string>;

TEST(Enumerated, PutsTheConjunctionBeforeTheLastItemOnly) {
  EXPECT_EQ(enumerated(Words{}, " and "), "");
  EXPECT_EQ(enumerated(Words{"a"}, " and "), "a");
  EXPECT_EQ(enumerated(Words{"a", "b"}, " and "), "a and b");
  EXPECT_EQ(enumerated(Words{"a", "b", "c"}, " or "), "a, b or c");
  EXPECT_EQ(enumerated(Words{"", "b"}, " and "), " and b") << "an empty item counts as an item";
}

TEST(Enumerated, AcceptsAFunctionOrAMemberForTheItemText) {
  struct Channel {
    std::string_view name;
  };
  const std::vector<Channel> channels{{"left"}, {"right"}};
  EXPECT_EQ(with_commas(channels, &Channel::name), "left, right");
  EXPECT_EQ(with_commas(std::vector<int>{3, 4, 16}, [](int code) { return std::to_string(code); }),
            "3, 4, 16");
}

/// Splits `text` into words as the shell does. Returns the words, each in square brackets.
std::string words_of(const std::string& text) {
  FILE* const shell = popen(("printf '[%s]' " + text).c_str(), "r");
  std::string words;
  for (int c = std::fgetc(shell); c != EOF; c = std::fgetc(shell)) words += static_cast<char>(c);
  pclose(shell);
  return words;
}

TEST(ShellWord, IsQuotedOnlyIfNecessary) {
  EXPECT_EQ(shell_word("p=1.5"), "p=1.5");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellWord, TheShellReadsAnyTextAsOneWord) {
  const std::vector<std::string> texts{"logs/day 1.csv",
                                       "it's",
                                       "''",
                                       "$HOME",
                                       "`id`",
                                       "a;b",
                                       "a\nb",
                                       "*",
                                       "~",
                                       "#",
                                       "\"",
                                       "\\",
                                       "&&",
                                       "",
                                       "-",
                                       "(",
                                       "!x",
                                       "grün"};
  for (const std::string& text : texts) EXPECT_EQ(words_of(shell_word(text)), "[" + text + "]");
}

}  // namespace
}  // namespace softgrip::text_test
