#include "tools/command_line/terminal.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace softgrip::tools::terminal_test {
namespace {

TEST(Terminal, ReplacesNonAsciiCharactersWithoutAUtf8Locale) {
  const std::string text = "13 ± 7 mm, ±5 %";
  ::setenv("LC_ALL", "C.UTF-8", 1);
  EXPECT_EQ(on_screen(text), text);
  ::setenv("LC_ALL", "C", 1);
  EXPECT_EQ(on_screen(text), "13 +- 7 mm, +-5 %");
  ::unsetenv("LC_ALL");
}

}  // namespace
}  // namespace softgrip::tools::terminal_test
