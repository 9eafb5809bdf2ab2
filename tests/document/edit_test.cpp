#include "document/edit.h"

#include <gtest/gtest.h>

namespace softgrip::document::edit_test {
namespace {

const std::string text =
    "# a rig\r\n"
    "name: x      # its name\n"
    "channels:\n"
    "  - name: left   # the first\n"
    "    sensor: {input: 0, at_v: [0,   10], is_mm: [ -5, 45 ]}   # by data sheet\n"
    "    valve:\n"
    "      output: 0     # the terminal\n"
    "  - name: right\n"
    "    sensor: {input: 1}\n"
    "    valve:\n"
    "      at_v:\n"
    "        - 0\n"
    "        - 10   # full scale\n";

class EditTest : public testing::Test {
 protected:
  [[nodiscard]] const Node::Entry& entry(std::size_t channel, const char* map) const {
    return *entry_of(&below(&document.root, {"channels"})->items[channel], map);
  }
  static std::string with(const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return changed;
  }
  Problems problems;
  Document document = parse("x.yaml", text, problems);
  Edit edit{document};
};

TEST_F(EditTest, NumbersOfAFlowListAreReplacedInPlace) {
  ASSERT_TRUE(problems.empty()) << problems.format();
  ASSERT_TRUE(edit.replace_numbers(*below(&entry(0, "sensor").value, {"at_v"}), {"1.25", "8"}));
  EXPECT_EQ(edit.text(), with("[0,   10]", "[1.25,   8]"));
}

TEST_F(EditTest, NumbersOfABlockListAreReplacedInPlace) {
  ASSERT_TRUE(edit.replace_numbers(*below(&entry(1, "valve").value, {"at_v"}), {"1", "2"}));
  EXPECT_EQ(edit.text(), with("- 0\n        - 10   # full", "- 1\n        - 2   # full"));
}

TEST_F(EditTest, AKeyIsAddedToAFlowMap) {
  ASSERT_TRUE(edit.add_key(entry(1, "sensor").value, "at_v", "[1, 2]"));
  ASSERT_TRUE(edit.add_key(entry(1, "sensor").value, "is_mm", "[3, 4]"));
  EXPECT_EQ(edit.text(), with("{input: 1}", "{input: 1, at_v: [1, 2], is_mm: [3, 4]}"));
}

TEST_F(EditTest, AKeyIsAddedAfterAListInAFlowMap) {
  ASSERT_TRUE(edit.add_key(entry(0, "sensor").value, "valid_v", "[1, 2]"));
  EXPECT_EQ(edit.text(), with("[ -5, 45 ]}", "[ -5, 45 ], valid_v: [1, 2]}"));
}

TEST_F(EditTest, AKeyIsAddedToABlockMap) {
  ASSERT_TRUE(edit.add_key(entry(0, "valve").value, "at_v", "[1, 2]"));
  EXPECT_EQ(edit.text(), with("# the terminal\n", "# the terminal\n      at_v: [1, 2]\n"));
}

TEST_F(EditTest, UnsupportedEditsAreRefusedWithoutAChange) {
  EXPECT_FALSE(edit.add_key(entry(1, "valve").value, "is_kpa", "[1, 2]"))
      << "the change is refused because the last value is a list on several lines";
  EXPECT_FALSE(edit.replace_numbers(entry(0, "sensor").value, {"1", "2"}))
      << "the edit is refused because the value is a map and not a list";
  EXPECT_FALSE(edit.replace_numbers(*below(&entry(0, "sensor").value, {"at_v"}), {"1"}));
  EXPECT_EQ(edit.text(), text);
}

TEST_F(EditTest, AnExistingCommentIsReplaced) {
  ASSERT_TRUE(edit.comment_above(entry(0, "sensor"), "# calibrated", "# calibrated on Monday"));
  const std::string once = edit.text();
  EXPECT_EQ(once, with("    sensor: {input: 0", "    # calibrated on Monday\n    sensor: {input: 0"));
  Problems none;
  const Document again = parse("x.yaml", once, none);
  Edit second(again);
  const Node::Entry& sensor = *entry_of(&below(&again.root, {"channels"})->items[0], "sensor");
  ASSERT_TRUE(second.comment_above(sensor, "# calibrated", "# calibrated on Tuesday"));
  EXPECT_EQ(second.text(),
            with("    sensor: {input: 0", "    # calibrated on Tuesday\n    sensor: {input: 0"));
}

TEST_F(EditTest, AKeyInsideALineGetsNoComment) {
  EXPECT_FALSE(edit.comment_above(*entry_of(&entry(0, "sensor").value, "input"), "# c", "# c"));
  EXPECT_EQ(edit.text(), text);
}

TEST_F(EditTest, LocationsBeyondTheTextHaveNoOffset) {
  EXPECT_EQ(offset_of(text, {2, 1}), 9U);
  EXPECT_FALSE(offset_of(text, {50, 1}).has_value());
  EXPECT_FALSE(offset_of("ab", {1, 9}).has_value());
}

}  // namespace
}  // namespace softgrip::document::edit_test
