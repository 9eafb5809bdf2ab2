#include "sysid/pages/page.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::page_test {
namespace {

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
  page.figure({evil, evil, {{chart}}});
  page.figure({evil, evil, {{chart, chart}}});
  page.appendix(evil);
  page.terms({{evil, evil}});
  const std::string html = page.to_html();
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_NE(html.find("&lt;img"), std::string::npos);
}

TEST(Page, IsSelfContainedAndOpensWithTheVerdict) {
  Page page("Identification", "The model fits.", Tone::good);
  page.provenance({{"software", software_and_version()}});
  page.section("Fit");
  const std::string html = page.to_html();
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_LT(html.find("The model fits."), html.find("softgrip "));
  EXPECT_LT(html.find("softgrip "), html.find(">Fit<"));
}

Chart noisy_chart(int samples) {
  Chart chart;
  Series series;
  for (int i = 0; i < samples; ++i) {
    series.x.push_back(i);
    series.y.push_back((i * 7919) % 1013);
  }
  chart.series = {series};
  return chart;
}

TEST(Page, FiguresAreNumberedAndDownloadable) {
  Page page("T", "V", Tone::good);
  for (const std::string name : {"error over time, tp1", "", "loops"})
    page.figure({name, "What it shows.", {{noisy_chart(100)}}});
  const std::string html = page.to_html();
  std::size_t at = 0;
  for (const std::string number : {"1", "2", "3"}) {
    const std::size_t next = html.find("<figcaption><b>Figure " + number + ".</b> What it shows.", at);
    ASSERT_NE(next, std::string::npos) << number;
    at = next;
  }
  EXPECT_NE(html.find("download=\"figure-1-error-over-time-tp1.svg\" href=\"data:image/svg+xml,%3Csvg"),
            std::string::npos);
  EXPECT_EQ(page.figures().size(), 3U);
  EXPECT_EQ(figure_stem(2, ""), "figure-2");
}

TEST(Page, SizeStaysBelowTheLimitForManyFigures) {
  Page page("T", "V", Tone::good);
  for (int i = 0; i < 100; ++i) page.figure({"loops", "Loops.", {{noisy_chart(20'000)}}});
  const std::string html = page.to_html();
  EXPECT_LT(html.size(), Page::most_bytes);
  EXPECT_NE(html.find("Figure 100. Loops. This figure is omitted"), std::string::npos);
  EXPECT_EQ(page.figures().size(), 100U) << "the omitted figures must still be available for --figures";
}

TEST(Page, HasBothColourSchemesAndAnAppendixPageBreak) {
  Page page("T", "V", Tone::good);
  for (const char* title : {"a", "b"}) page.section(title);
  EXPECT_EQ(page.to_html().find("<nav>"), std::string::npos);
  page.appendix("f");
  const std::string html = page.to_html();
  EXPECT_NE(html.find("@media screen and (prefers-color-scheme:dark){:root{--measured"), std::string::npos);
  EXPECT_NE(html.find("<a href=\"#s3\">f</a>"), std::string::npos);
  EXPECT_NE(html.find("<h2 id=\"s3\" class=\"appendix\">f</h2>"), std::string::npos);
  EXPECT_NE(html.find(".appendix{break-before:page}"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::page_test
