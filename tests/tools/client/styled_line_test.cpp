#include "tools/client/styled_line.h"

#include <gtest/gtest.h>

namespace softgrip::tools::styled_line_test {
namespace {

using Lines = std::vector<std::string>;

TEST(StyledLine, MarksALineThatIsCutOff) {
  const ViewStyle ten{10, false, false};
  EXPECT_EQ(Line(ten).add("0123456789").text(), "0123456789");
  EXPECT_EQ(Line(ten).add("01234").add("56789a").text(), "012345678>");
  const ViewStyle unicode{10, false, true};
  EXPECT_EQ(Line(unicode).add("0123456789a").text(), "012345678…");
}

TEST(StyledLine, EscapeSequencesAndGlyphBytesOccupyNoColumns) {
  const ViewStyle three{3, true, true};
  EXPECT_EQ(Line(three).add_glyph("▁").add_glyph("▂").add("x", Tone::bad).text(), "▁▂\x1b[1;31mx\x1b[0m");
  EXPECT_EQ(Line(three).add_glyph("▁").add_glyph("▂").add_glyph("▃").add_glyph("▄").text(),
            "▁▂\x1b[2m…\x1b[0m");
}

TEST(StyledLine, SpansFlowAndDoNotBeginALineWithBlanks) {
  const ViewStyle style{12, false, false};
  EXPECT_EQ(wrap_spans(style, {{"abcdef"}, {"   ghi"}, {"   jkl"}}, 2), (Lines{"abcdef   ghi", "  jkl"}));
  EXPECT_EQ(wrap_spans(style, {{"abcdefghijklmno"}, {"  p"}}, 2), (Lines{"abcdefghijk>", "  p"}));
}

TEST(StyledLine, TextBreaksAtBlanks) {
  const ViewStyle style{10, false, false};
  EXPECT_EQ(wrap_text(style, "one two three four", Tone::plain, 2), (Lines{"one two", "  three", "  four"}));
  EXPECT_EQ(wrap_text(style, "abcdefghijklm", Tone::plain, 2), (Lines{"abcdefghij", "  klm"}));
  EXPECT_EQ(wrap_text(style, "one\ntwo", Tone::plain, 2), (Lines{"one", "  two"}));
  EXPECT_EQ(wrap_text(style, "", Tone::plain, 2), (Lines{""}));
  for (const std::size_t columns : {0U, 1U, 2U}) {
    EXPECT_FALSE(wrap_text({columns, false, false}, "one two", Tone::plain, 4).empty())
        << "the function must return even if the line is too narrow";
  }
}

}  // namespace
}  // namespace softgrip::tools::styled_line_test
