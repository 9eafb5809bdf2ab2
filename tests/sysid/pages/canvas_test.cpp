#include "sysid/pages/canvas.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::canvas_test {
namespace {

TEST(Canvas, EveryElementHasItsColourWithAndWithoutAStyleSheet) {
  Canvas canvas;
  canvas.line({1, 2}, {3, 4}, Colour::error);
  EXPECT_EQ(canvas.markup(), "<path d=\"M1 2l2 2\" class=\"s-error\" stroke=\"#d55e00\"/>");
  Canvas framed;
  framed.framed_box(0, 0, 10, 5, Colour::paper, Colour::axis);
  EXPECT_NE(framed.markup().find("class=\"f-paper s-axis\" fill=\"#ffffff\" stroke=\"#8a949c\""),
            std::string::npos);
}

TEST(Canvas, BoxWidthIsNeverNegative) {
  Canvas canvas;
  canvas.box(0, 0, -3, 5, Colour::grid);
  EXPECT_NE(canvas.markup().find("width=\"0.0\""), std::string::npos);
}

TEST(Canvas, WordsAreEscapedAndMeasuredByCharacters) {
  Canvas canvas;
  canvas.words({0, 0}, Anchor::end, "a < b");
  EXPECT_NE(canvas.markup().find("text-anchor=\"end\""), std::string::npos);
  EXPECT_NE(canvas.markup().find(">a &lt; b</text>"), std::string::npos);
  EXPECT_DOUBLE_EQ(text_width("mm\xc2\xb2"), text_width("mm2"));
}

}  // namespace
}  // namespace softgrip::sysid::canvas_test
