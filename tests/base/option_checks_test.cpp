#include "base/option_checks.h"

#include <gtest/gtest.h>

#include <string>

namespace softgrip::option_checks_test {
namespace {

/// Returns true if the check accepts the text.
bool accepts(const CLI::Validator& check, std::string text) {
  return check(text).empty();
}

TEST(OptionChecks, NumbersOutsideOfTheRangeAreRefused) {
  const CLI::Validator check = number_between(0.5, 1e8);
  for (const char* good : {"0.5", "1e8", "3"}) EXPECT_TRUE(accepts(check, good)) << good;
  for (const char* bad : {"0.49", "1.01e8", "nan", "inf", "-1", "", "3 s"})
    EXPECT_FALSE(accepts(check, bad)) << bad;
  EXPECT_EQ(check.get_description(), "a number from 0.5 to 1e+08");
}

TEST(OptionChecks, PositiveNumbersAreFinite) {
  for (const char* good : {"1e-9", "2"}) EXPECT_TRUE(accepts(positive_number(), good)) << good;
  for (const char* bad : {"0", "-1", "nan", "inf", "x"}) EXPECT_FALSE(accepts(positive_number(), bad)) << bad;
}

TEST(OptionChecks, SeedsAreWholeNumbersThatFit) {
  for (const char* good : {"0", "18446744073709551615"}) EXPECT_TRUE(accepts(seed_number(), good)) << good;
  for (const char* bad : {"-1", "18446744073709551616", "1.5", "1e3", " 1", ""})
    EXPECT_FALSE(accepts(seed_number(), bad)) << bad;
}

}  // namespace
}  // namespace softgrip::option_checks_test
