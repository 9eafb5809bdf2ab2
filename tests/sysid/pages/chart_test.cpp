#include "sysid/pages/chart.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sysid/pages/canvas.h"
#include "sysid/pages/chart_scale.h"
#include "sysid/pages/figure.h"
#include "tests/support/text.h"

namespace softgrip::sysid::chart_test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::vector<double> at_of(const std::vector<Tick>& ticks) {
  std::vector<double> values;
  for (const Tick& tick : ticks) values.push_back(tick.at);
  return values;
}

TEST(Scale, TicksAreRoundNumbersInsideTheAxis) {
  for (const double width : {3e-7, 0.02, 1.0, 7.3, 42.0, 1.9e6}) {
    for (const double lower : {-0.7 * width, 0.0, 13 * width}) {
      const Axis axis;
      const Scale scale(axis, lower, lower + width, 0, 500, false);
      const auto ticks = scale.ticks(6);
      ASSERT_GE(ticks.size(), 2U) << width;
      EXPECT_LE(ticks.size(), 8U) << width;
      const double step = ticks[1].at - ticks[0].at;
      const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
      EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                  std::abs(mantissa - 5) < 1e-6)
          << step;
      for (const Tick& tick : ticks) {
        EXPECT_GE(tick.at, lower - 1e-9 * width);
        EXPECT_LE(tick.at, lower + width + 1e-9 * width);
      }
    }
  }
}

TEST(Scale, TickLabelsAreDistinct) {
  const Axis axis;
  const Scale scale(axis, 1000.001, 1000.0042, 0, 500, false);
  const auto ticks = scale.ticks(6);
  for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_NE(ticks[i].text, ticks[i - 1].text);
}

TEST(Scale, ZeroIsWrittenWithoutASign) {
  const Axis axis;
  for (const Tick& tick : Scale(axis, -1, 1, 0, 500, false).ticks(5))
    EXPECT_NE(tick.text.substr(0, 3), "-0.0");
}

TEST(Scale, LogarithmicTicksArePowersOfTen) {
  Axis axis;
  axis.logarithmic = true;
  EXPECT_EQ(at_of(Scale(axis, 0.5, 2000, 0, 500, false).ticks(6)), (std::vector<double>{1, 10, 100, 1000}));
}

TEST(Scale, AxisExistsForOneValueOrNoValue) {
  const Axis axis;
  EXPECT_LT(Scale(axis, 5, 5, 0, 500, true).lower(), 5);
  const Scale nothing(axis, 1e300, -1e300, 0, 500, true);
  EXPECT_LT(nothing.lower(), nothing.upper());
}

/// Returns the texts of a chart with their horizontal positions [px].
std::vector<std::pair<double, std::string>> texts_of(const std::string& markup) {
  std::vector<std::pair<double, std::string>> texts;
  const std::regex pattern(R"re(<text x="([-0-9.]+)"[^>]*>([^<]*)</text>)re");
  for (std::sregex_iterator i(markup.begin(), markup.end(), pattern), end; i != end; ++i)
    texts.emplace_back(std::stod((*i)[1]), (*i)[2]);
  return texts;
}

TEST(Chart, LongNamesOfCategoriesAreWrappedAndDoNotOverlap) {
  const std::vector<std::string> names = {"asymmetric_hysteresis", "rate_dependent_hysteresis",
                                          "pressure_saturation",   "sensor_nonlinearity",
                                          "stress_softening",      "ageing",
                                          "sensor_drift",          "slow_creep"};
  Chart chart = chart_over(names);
  chart.series = {points_over_names("error", Colour::model, std::vector<double>(names.size(), 1.0))};
  const std::string markup = markup_of({{chart}});
  const double slot_px = static_cast<double>(chart.width) / static_cast<double>(names.size());
  std::size_t parts = 0;
  for (const auto& [x, text] : texts_of(markup)) {
    if (text.size() < 5 || text == "error") continue;
    ++parts;
    EXPECT_LT(text_width(text), slot_px) << text;
  }
  EXPECT_GE(parts, 12U) << markup;
  EXPECT_EQ(markup.find("asymmetric_hysteresis"), std::string::npos);
}

TEST(Thinning, KeepsEveryExtreme) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  std::vector<Pixel> curve;
  for (int i = 0; i < 200'000; ++i) curve.push_back({700.0 * i / 200'000, noise(random)});
  curve[123'456].y = 50;
  curve[77'777].y = -60;
  const auto kept = thinned(curve);
  EXPECT_LE(kept.size(), 2 * 700U);
  double highest = 0;
  double lowest = 0;
  for (const Pixel& p : kept) {
    highest = std::max(highest, p.y);
    lowest = std::min(lowest, p.y);
  }
  EXPECT_EQ(highest, 50);
  EXPECT_EQ(lowest, -60);
  // In each pixel column, the minimum and the maximum of the drawn curve must equal those of the data.
  std::vector<std::pair<double, double>> data(700, {1e9, -1e9});
  auto drawn = data;
  for (const Pixel& p : curve) {
    auto& [low, high] = data[static_cast<std::size_t>(p.x)];
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  for (const Pixel& p : kept) {
    auto& [low, high] = drawn[static_cast<std::size_t>(p.x)];
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  EXPECT_EQ(drawn, data);
}

TEST(Thinning, ShortCurvesStayUnchanged) {
  const std::vector<Pixel> curve{{0, 1}, {10, 5}, {20, 2}};
  EXPECT_EQ(thinned(curve).size(), 3U);
}

TEST(Thinning, AGapStaysAGap) {
  const auto kept = thinned({{0, 1}, {10, 5}, {nan_value, 0}, {nan_value, 0}, {20, 2}, {30, 4}});
  ASSERT_EQ(kept.size(), 5U);
  EXPECT_TRUE(std::isnan(kept[2].x));
  EXPECT_EQ(path_data(kept), "M0 1l10 4M20 2l10 2");
}

TEST(Thinning, RepeatedLoopIsDrawnOnce) {
  std::vector<Pixel> curve;
  for (int i = 0; i < 1000 * 360; ++i) {
    const double angle = i * std::numbers::pi / 180;
    curve.push_back({200 + 100 * std::cos(angle), 200 + 100 * std::sin(angle)});
  }
  const auto kept = thinned(curve);
  EXPECT_LT(kept.size(), 2000U);
  EXPECT_GT(kept.size(), 300U);
}

std::string to_svg(std::vector<Chart> charts) {
  return svg_file_of({"a name", "", stacked(std::move(charts))});
}
std::string to_svg(const Chart& chart) {
  return to_svg(std::vector<Chart>{chart});
}

Chart a_chart() {
  Chart chart;
  chart.title = "Overlay <of> \"a\" & b";
  chart.x.label = "time [s]";
  chart.y.label = "displacement [mm]";
  Series line{.label = "model", .x = {}, .y = {}, .y_upper = {}, .colour = Colour::model};
  for (int i = 0; i < 100'000; ++i) {
    line.x.push_back(0.001 * i);
    line.y.push_back(std::sin(0.0001 * i) + 0.1 * std::sin(77.0 * i));
  }
  chart.series = {line};
  chart.marks = {{Mark::Direction::vertical, 40, "released"}};
  return chart;
}

TEST(Chart, SvgIsSmallAndEscaped) {
  const std::string svg = to_svg(a_chart());
  EXPECT_LT(svg.size(), 60'000U);
  EXPECT_EQ(svg.find("<of>"), std::string::npos);
  EXPECT_NE(svg.find("&lt;of&gt;"), std::string::npos);
  EXPECT_NE(svg.find("released"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Chart, TagsAreBalanced) {
  Chart chart = a_chart();
  for (const auto style :
       {Series::Style::points, Series::Style::band, Series::Style::bars, Series::Style::steps}) {
    Series series{
        .label = "s", .x = {1, 2, nan_value, 4}, .y = {1, nan_value, 3, 4}, .y_upper = {2, 3, 4, 5}};
    series.style = style;
    chart.series.push_back(series);
  }
  const std::string svg = to_svg({chart, chart});
  for (const std::string tag : {"svg", "g", "text"}) {
    EXPECT_EQ(test::count_of(svg, "<" + tag + " ") + test::count_of(svg, "<" + tag + ">"),
              test::count_of(svg, "</" + tag + ">"))
        << tag;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Chart, EmptyChartIsValidSvg) {
  EXPECT_NE(to_svg(Chart{}).find("</svg>"), std::string::npos);
  Chart chart;
  chart.series = {Series{.label = "", .x = {nan_value}, .y = {nan_value}, .y_upper = {}}};
  EXPECT_EQ(to_svg(chart).find("nan"), std::string::npos);
}

TEST(Chart, UnitsOfAxesAreDrawnInWords) {
  EXPECT_EQ(in_words("rate of the pressure [kPa/s]"), "rate of the pressure in kilopascals per second");
  EXPECT_EQ(in_words("error [furlong]"), "error [furlong]");
  EXPECT_EQ(in_words("[mm]"), "millimetres");
  EXPECT_EQ(in_words("x[mm]"), "x[mm]");
  EXPECT_NE(to_svg(a_chart()).find(">displacement in millimetres<"), std::string::npos);
}

// The chart must not draw every point. With all 600,000 noisy readings, the file would have several
// megabytes.
TEST(Chart, LongLogMakesASmallFile) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise;
  Chart chart;
  Series loop;
  for (int i = 0; i < 600'000; ++i) {
    const double angle = 1e-3 * i;
    loop.x.push_back(30 - 30 * std::cos(angle));
    loop.y.push_back(10 * std::sin(angle) + 2 * noise(random));
  }
  Series cloud = loop;
  cloud.style = Series::Style::points;
  chart.series = {loop, cloud};
  EXPECT_LT(to_svg(chart).size(), 150'000U);
}

TEST(Chart, FileHasBothColourSchemesAndInlineColours) {
  const std::string svg = to_svg(a_chart());
  EXPECT_NE(svg.find("@media screen and (prefers-color-scheme:dark)"), std::string::npos);
  EXPECT_NE(svg.find("class=\"s-model\" stroke=\"#0072b2\""), std::string::npos);
  EXPECT_NE(svg.find(".s-model{stroke:var(--model)}"), std::string::npos);
  const std::string inside = svg_of({"", "", stacked({a_chart()})});
  EXPECT_EQ(inside.find("<style"), std::string::npos) << "the page contains the style";
}

TEST(Chart, SeriesAndLegendUseTheDashPattern) {
  Chart chart = a_chart();
  chart.series.front().dash = Dash::dotted;
  // the curve and the legend each contain the dotted line once
  EXPECT_EQ(test::count_of(to_svg(chart), "stroke-dasharray=\"1.5 2.5\""), 2U);
}

TEST(Figure, CsvContainsAllValuesOfTheFigure) {
  Chart above;
  above.y.label = "displacement [mm]";
  above.series = {Series{.label = "read, twice", .x = {0, 0.5}, .y = {1, nan_value}, .y_upper = {}},
                  Series{.label = "model", .x = {0, 0.5}, .y = {1.25, 2}, .y_upper = {}}};
  Chart below;
  below.x.label = "time [s]";
  below.y.label = "error [mm]";
  below.series = {Series{.label = "", .x = {0.5}, .y = {-1}, .y_upper = {}}};
  EXPECT_EQ(csv_of({"", "", stacked({above, below})}),
            "time [s],\"read, twice: displacement [mm]\",model: displacement [mm],time [s],error [mm]\n"
            "0,1,1.25,0.5,-1\n"
            "0.5,,2,,\n");
}

TEST(Chart, EqualValuesGiveIdenticalSvg) {
  EXPECT_EQ(to_svg(a_chart()), to_svg(a_chart()));
}

TEST(Chart, CategoryChartDrawsSquareAndRoundPoints) {
  Chart chart = chart_over({"first", "second", "third"});
  chart.series = {points_over_names("square", Colour::error, {1, 2, 3}),
                  points_over_names("round", Colour::model, {2, nan_value, 1})};
  const std::string svg = to_svg(chart);
  for (const char* name : {"first", "second", "third"}) EXPECT_NE(svg.find(name), std::string::npos) << name;
  EXPECT_EQ(test::count_of(svg, "h.1"), 3U);
  EXPECT_EQ(test::count_of(svg, "h0"), 2U);
}

}  // namespace
}  // namespace softgrip::sysid::chart_test
