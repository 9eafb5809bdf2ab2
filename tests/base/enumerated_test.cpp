#include "base/enumerated.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip::enumerated_test {
namespace {

using Words = std::vector<std::string>;

TEST(Enumerated, PutsItsWordBeforeTheLastOnly) {
  EXPECT_EQ(enumerated(Words{}, " and "), "");
  EXPECT_EQ(enumerated(Words{"a"}, " and "), "a");
  EXPECT_EQ(enumerated(Words{"a", "b"}, " and "), "a and b");
  EXPECT_EQ(enumerated(Words{"a", "b", "c"}, " or "), "a, b or c");
  EXPECT_EQ(enumerated(Words{"", "b"}, " and "), " and b") << "an empty item counts as an item";
}

TEST(Enumerated, TakesWhatMakesATextOfAnItemOrTheMemberThatHoldsIt) {
  struct Channel {
    std::string_view name;
  };
  const std::vector<Channel> channels{{"left"}, {"right"}};
  EXPECT_EQ(with_commas(channels, &Channel::name), "left, right");
  EXPECT_EQ(with_commas(std::vector<int>{3, 4, 16}, [](int code) { return std::to_string(code); }),
            "3, 4, 16");
}

}  // namespace
}  // namespace softgrip::enumerated_test
