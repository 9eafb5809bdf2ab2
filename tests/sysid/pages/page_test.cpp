#include "sysid/pages/page.h"

#include <gtest/gtest.h>

#include "sysid/pages/markup.h"

namespace softgrip::sysid {
namespace {

TEST(Markup, NothingActiveSurvives) {
  EXPECT_EQ(escaped("<script>alert('x & \"y\"')</script>"),
            "&lt;script&gt;alert(&#39;x &amp; &quot;y&quot;&#39;)&lt;/script&gt;");
  EXPECT_EQ(escaped(std::string("a\0b\x1b", 4)),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd");
}

TEST(Page, EveryTextThatEntersIsEscaped) {
  const std::string evil = "\"><img src=x onerror=alert(1)>";
  Page page(evil, evil, Tone::bad);
  page.provenance({{evil, evil}});
  page.section(evil);
  page.subsection(evil);
  page.paragraph(evil);
  page.list({evil});
  page.table({evil, {evil}, {true}, {{evil}}});
  page.code(evil);
  Chart chart;
  chart.title = chart.x.label = chart.y.label = evil;
  chart.series = {Series{.label = evil, .x = {0, 1}, .y = {0, 1}, .y_upper = {}}};
  chart.marks = {{Mark::Direction::horizontal, 0.5, evil}, {Mark::Direction::vertical, 0.5, evil}};
  chart.x.categories = {evil};
  page.figure(chart, evil);
  page.figure_row({chart, chart}, evil);
  const std::string html = page.to_html();
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_NE(html.find("&lt;img"), std::string::npos);
}

TEST(Page, StandsAloneAndOpensWithTheVerdict) {
  Page page("Identification", "The model fits.", Tone::good);
  page.provenance({{"software", software_and_version()}});
  page.section("Fit");
  const std::string html = page.to_html();
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_LT(html.find("The model fits."), html.find("softgrip "));
  EXPECT_LT(html.find("softgrip "), html.find("<h2>Fit"));
}

}  // namespace
}  // namespace softgrip::sysid
