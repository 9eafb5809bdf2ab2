#include "base/result/table.h"

#include <gtest/gtest.h>

namespace softgrip::result::table_test {
namespace {

TEST(Html, EscapesMarkupAndControlCharacters) {
  EXPECT_EQ(escaped("<script>alert('x & \"y\"')</script>"),
            "&lt;script&gt;alert(&#39;x &amp; &quot;y&quot;&#39;)&lt;/script&gt;");
  EXPECT_EQ(escaped(std::string("a\0b\x1b", 4)),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd");
}

TEST(Table, TextTableHasAlignedColumns) {
  const Table table{
      "Errors", {"run", "error"}, {false, true}, {{"a", "0.1"}, {"l\xc3\xa4nger", "\xe2\x80\x93"}}};
  EXPECT_EQ(text_of(table),
            "Errors\n"
            "  run     error\n"
            "  a         0.1\n"
            "  l\xc3\xa4nger      \xe2\x80\x93\n");
}

TEST(Html, NumericCellsAreRightAligned) {
  const Table table{"a & b", {"run", "error", "note"}, {false, true}, {{"<x>", "0.1", "y"}}};
  EXPECT_EQ(html_of(table),
            "<div class=\"scroll\"><table><caption>a &amp; b</caption>\n"
            "<thead><tr><th>run</th><th class=\"n\">error</th><th>note</th></tr></thead><tbody>\n"
            "<tr><td>&lt;x&gt;</td><td class=\"n\">0.1</td><td>y</td></tr>\n"
            "</tbody></table></div>\n");
  EXPECT_EQ(html_of(Terms{{"noise", "< 1 mm"}}), "<dl>\n<dt>noise</dt>\n<dd>&lt; 1 mm</dd>\n</dl>\n");
}

}  // namespace
}  // namespace softgrip::result::table_test
