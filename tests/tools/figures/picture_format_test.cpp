#include "tests/support/text.h"
#include "tools/figures/figure_files.h"

#include <gtest/gtest.h>

namespace softgrip::tools::picture_format_test {
namespace {

sysid::Figure a_figure() {
  sysid::Chart chart;
  chart.x.label = "time [s]";
  sysid::Series series;
  series.label = "measured";
  for (int i = 0; i < 1000; ++i) {
    series.x.push_back(i);
    series.y.push_back((i * 7919) % 13);
  }
  chart.series = {series};
  return {"a figure", "What it shows.", {{chart}}};
}

TEST(PictureFormat, FollowsFromTheFileNameExtension) {
  EXPECT_EQ(picture_format_of("out/a.svg"), PictureFormat::svg);
  EXPECT_EQ(picture_format_of("A.PDF"), PictureFormat::pdf);
  EXPECT_EQ(picture_format_of("a.b.png"), PictureFormat::png);
  EXPECT_EQ(picture_format_of("a.html"), PictureFormat::html);
  EXPECT_FALSE(picture_format_of("a.bmp"));
  EXPECT_FALSE(picture_format_of("svg"));
  EXPECT_FALSE(picture_format_of("a.svg/b"));
}

TEST(PictureFormat, APdfIsOnePageOfTheFiguresSize) {
  const auto pdf = bytes_of(a_figure(), PictureFormat::pdf);
  ASSERT_TRUE(pdf) << pdf.error();
  EXPECT_EQ(pdf->substr(0, 5), "%PDF-");
  EXPECT_EQ(test::count_of(*pdf, "/Type /Page") - test::count_of(*pdf, "/Type /Pages"), 1U);
  EXPECT_NE(pdf->find("/MediaBox [ 0 0 570 210 ]"), std::string::npos) << "760 x 280 pixels";
}

TEST(PictureFormat, PngSvgAndHtmlHaveTheirFileSignatures) {
  EXPECT_EQ(bytes_of(a_figure(), PictureFormat::png)->substr(1, 3), "PNG");
  EXPECT_EQ(bytes_of(a_figure(), PictureFormat::svg)->substr(0, 4), "<svg");
  const std::string html = *bytes_of(a_figure(), PictureFormat::html);
  EXPECT_NE(html.find("Figure 1.</b> What it shows."), std::string::npos);
}

TEST(SvgRendering, RefusesTextThatIsNotSvg) {
  EXPECT_FALSE(pdf_of("<svg"));
  EXPECT_FALSE(png_of("no picture"));
}

}  // namespace
}  // namespace softgrip::tools::picture_format_test
