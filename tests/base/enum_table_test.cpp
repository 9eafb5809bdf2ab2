#include "base/enum_table.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace softgrip::enum_table_test {
namespace {

enum class Colour : std::uint8_t { red, green2, blue };
constexpr auto colour_names =
    enum_names<Colour>({{Colour::red, "red"}, {Colour::green2, "green"}, {Colour::blue, "blue"}});

static_assert(is_enumerator<Colour::green2>() && is_enumerator<static_cast<Colour>(2)>());
static_assert(
    !is_enumerator<static_cast<Colour>(3)>(),
    "the check for a missing row requires that the value after the last enumerator is no enumerator");

TEST(EnumTable, NamesGoBothWays) {
  EXPECT_EQ(colour_names.size(), 3U);
  for (const auto& [colour, name] : colour_names) {
    EXPECT_EQ(colour_names[colour], name);
    EXPECT_EQ(colour_names.find(name), colour);
  }
  EXPECT_FALSE(colour_names.find("green2"));
  EXPECT_EQ(colour_names.names(), (std::vector<std::string>{"red", "green", "blue"}));
}

TEST(EnumTable, ANumberWithoutEnumeratorHasTheFirstRow) {
  EXPECT_EQ(colour_names[static_cast<Colour>(3)], "red");
}

}  // namespace
}  // namespace softgrip::enum_table_test
