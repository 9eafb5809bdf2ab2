#include "base/shell_word.h"

#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip::shell_word_test {
namespace {

/// Splits `text` into words as the shell does. Returns the words, each in square brackets.
std::string words_of(const std::string& text) {
  FILE* const shell = popen(("printf '[%s]' " + text).c_str(), "r");
  std::string words;
  for (int c = std::fgetc(shell); c != EOF; c = std::fgetc(shell)) words += static_cast<char>(c);
  pclose(shell);
  return words;
}

TEST(ShellWord, IsQuotedOnlyWhereItMustBe) {
  EXPECT_EQ(shell_word("p=1.5"), "p=1.5");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellWord, IsOneWordToTheShellWhateverStandsInIt) {
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
}  // namespace softgrip::shell_word_test
