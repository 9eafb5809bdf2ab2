#include "sysid/pages/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "sysid/pages/chart_path.h"
#include "sysid/pages/chart_scale.h"
#include "sysid/pages/markup.h"

namespace softgrip::sysid {
namespace {

// Okabe and Ito's palette: distinct for all kinds of colour vision, and in grey.
std::string_view code_of(Colour colour) {
  switch (colour) {
    case Colour::measured:
      return "#4d4d4d";
    case Colour::model:
      return "#0072b2";
    case Colour::error:
      return "#d55e00";
    case Colour::other:
      return "#cc79a7";
    case Colour::faint:
      return "#b8c4cc";
    case Colour::good:
      return "#009e73";
    case Colour::bad:
      return "#a3291f";
  }
  return "#000";
}

constexpr std::string_view grid_colour = "#e4e8eb";
constexpr std::string_view axis_colour = "#8a949c";
constexpr std::string_view text_colour = "#30383e";
constexpr double font_px = 11;
/// Width of a character, about: for margins and legends without a font at hand.
constexpr double character_px = 6.1;

double text_width(std::string_view text) {
  const auto characters = std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80; });
  return character_px * static_cast<double>(characters);
}

struct Range {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  void include(double value, bool logarithmic) {
    if (!std::isfinite(value) || (logarithmic && value <= 0)) return;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
};

/// Draws one chart, its upper left corner at (0, top).
class Painter {
 public:
  /// @param left  where the axes begin [px]: at least left_margin().
  Painter(const Chart& chart, double top, double left) : chart_(chart), top_(top), left_(left) {
    for (const Series& s : chart.series) {
      for (const double value : s.x) x_range_.include(value, chart.x.logarithmic);
      for (const double value : s.y) y_range_.include(value, chart.y.logarithmic);
      for (const double value : s.y_upper) y_range_.include(value, chart.y.logarithmic);
      if (s.style == Series::Style::bars) y_range_.include(0, false);
    }
    for (const Mark& mark : chart.marks) {
      const bool horizontal = mark.direction == Mark::Direction::horizontal;
      (horizontal ? y_range_ : x_range_).include(mark.at, (horizontal ? chart.y : chart.x).logarithmic);
    }
  }

  /// Room for the widest number of the axis.
  [[nodiscard]] double left_margin() const {
    const Scale trial(chart_.y, y_range_.lowest, y_range_.highest, 100, 0, true);
    double widest = 0;
    for (const Tick& tick : trial.ticks(6)) widest = std::max(widest, text_width(tick.text));
    return widest + (chart_.y.label.empty() ? 12 : 30);
  }

  std::string draw() {
    lay_out();
    const bool margin = std::any_of(chart_.series.begin(), chart_.series.end(), [](const Series& s) {
      return s.style == Series::Style::bars || s.style == Series::Style::points;
    });
    const Scale x(chart_.x, x_range_.lowest, x_range_.highest, left_, right_, margin);
    const Scale y(chart_.y, y_range_.lowest, y_range_.highest, lower_, upper_, true);
    text_.clear();
    grid(x, y);
    // A nested <svg> clips what leaves the axes, without the document-wide names that a clip path needs.
    const std::string box = fixed(left_, 1) + ' ' + fixed(upper_, 1) + ' ' + fixed(right_ - left_, 1) + ' ' +
                            fixed(lower_ - upper_, 1);
    text_ += "<svg x=\"" + fixed(left_, 1) + "\" y=\"" + fixed(upper_, 1) + "\" width=\"" +
             fixed(right_ - left_, 1) + "\" height=\"" + fixed(lower_ - upper_, 1) + "\" viewBox=\"" + box +
             "\">";
    for (const Series& s : chart_.series) series(s, x, y);
    text_ += "</svg>";
    for (const Mark& mark : chart_.marks) draw_mark(mark, x, y);
    title_and_legend();
    axis_labels();
    return text_;
  }

 private:
  void lay_out() {
    right_ = chart_.width - 14;
    const bool has_head = !chart_.title.empty() || has_legend();
    upper_ = top_ + (has_head ? 26 : 10);
    lower_ = top_ + chart_.height - (chart_.x.label.empty() ? 22 : 40);
  }
  [[nodiscard]] bool has_legend() const {
    return std::any_of(chart_.series.begin(), chart_.series.end(),
                       [](const Series& s) { return !s.label.empty(); });
  }

  void line(double x1, double y1, double x2, double y2, std::string_view colour, std::string_view more = {}) {
    text_ += "<path d=\"" + path_data({{x1, y1}, {x2, y2}}) + "\" stroke=\"" + std::string(colour) + "\"" +
             std::string(more) + "/>";
  }
  void words(double x, double y, std::string_view anchor, std::string_view content,
             std::string_view more = {}) {
    text_ += "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" +
             std::string(anchor) + "\" fill=\"" + std::string(text_colour) + "\"" + std::string(more) + ">" +
             escaped(content) + "</text>";
  }

  void grid(const Scale& x, const Scale& y) {
    const int most_x = std::max(2, static_cast<int>((right_ - left_) / 75));
    const int most_y = std::max(3, static_cast<int>((lower_ - upper_) / 34));
    for (const Tick& tick : y.ticks(most_y)) {
      line(left_, y.px(tick.at), right_, y.px(tick.at), grid_colour);
      words(left_ - 6, y.px(tick.at) + 4, "end", tick.text);
    }
    for (const Tick& tick : x.ticks(most_x)) {
      if (chart_.x.categories.empty()) line(x.px(tick.at), upper_, x.px(tick.at), lower_, grid_colour);
      words(x.px(tick.at), lower_ + 15, "middle", tick.text);
    }
    line(left_, lower_, right_, lower_, axis_colour);
    if (y.lower() < 0 && y.upper() > 0 && !chart_.y.logarithmic)
      line(left_, y.px(0), right_, y.px(0), axis_colour);
  }

  void series(const Series& s, const Scale& x, const Scale& y) {
    const std::string colour(code_of(s.colour));
    const std::size_t size = std::min(s.x.size(), s.y.size());
    std::vector<Pixel> curve;
    curve.reserve(size);
    const auto pixel = [&](double vx, double vy) {
      const bool bad = (chart_.x.logarithmic && vx <= 0) || (chart_.y.logarithmic && vy <= 0) ||
                       !std::isfinite(vx) || !std::isfinite(vy);
      if (bad) return Pixel{std::numeric_limits<double>::quiet_NaN(), 0};
      return Pixel{x.px(vx), y.px(vy)};
    };
    for (std::size_t i = 0; i < size; ++i) {
      if (s.style == Series::Style::steps && i > 0) curve.push_back(pixel(s.x[i], s.y[i - 1]));
      curve.push_back(pixel(s.x[i], s.y[i]));
    }
    switch (s.style) {
      case Series::Style::line:
      case Series::Style::steps:
        text_ += "<path d=\"" + path_data(thinned(curve)) + "\" stroke=\"" + colour + "\" stroke-width=\"" +
                 fixed(s.width, 1) + "\"" + (s.dashed ? " stroke-dasharray=\"5 4\"" : "") + "/>";
        break;
      case Series::Style::points:
        points(curve, colour, s.width);
        break;
      case Series::Style::band:
        band(s, curve, colour, pixel);
        break;
      case Series::Style::bars:
        bars(s, curve, colour, y.px(std::max(0.0, y.lower())));
        break;
    }
  }

  /// Dots as strokes of no length with round ends; dots on the same pixel are drawn once.
  void points(std::vector<Pixel> curve, const std::string& colour, double radius) {
    for (Pixel& p : curve) p = {std::round(p.x * 2) / 2, std::round(p.y * 2) / 2};
    std::sort(curve.begin(), curve.end(),
              [](const Pixel& a, const Pixel& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    curve.erase(std::unique(curve.begin(), curve.end(),
                            [](const Pixel& a, const Pixel& b) { return a.x == b.x && a.y == b.y; }),
                curve.end());
    std::string data;
    for (const Pixel& p : curve) {
      if (std::isfinite(p.x)) data += path_data({p}) + "h0";
    }
    text_ += "<path d=\"" + data + "\" stroke=\"" + colour + "\" stroke-linecap=\"round\" stroke-width=\"" +
             fixed(2 * radius, 1) + "\"/>";
  }

  template <class ToPixel>
  void band(const Series& s, const std::vector<Pixel>& lower_edge, const std::string& colour, ToPixel pixel) {
    std::vector<Pixel> upper_edge;
    for (std::size_t i = 0; i < std::min(lower_edge.size(), s.y_upper.size()); ++i) {
      upper_edge.push_back(pixel(s.x[i], s.y_upper[i]));
    }
    std::vector<Pixel> outline = thinned(lower_edge);
    const std::vector<Pixel> back = thinned(upper_edge);
    outline.insert(outline.end(), back.rbegin(), back.rend());
    std::erase_if(outline, [](const Pixel& p) { return !std::isfinite(p.x); });
    text_ += "<path d=\"" + path_data(outline) + "z\" fill=\"" + colour +
             "\" fill-opacity=\"0.18\" stroke=\"none\"/>";
  }

  void bars(const Series& s, const std::vector<Pixel>& tops, const std::string& colour, double zero) {
    double spacing = right_ - left_;
    for (std::size_t i = 1; i < tops.size(); ++i)
      spacing = std::min(spacing, std::abs(tops[i].x - tops[i - 1].x));
    if (s.x.size() < 2 && !chart_.x.categories.empty()) {
      spacing = (right_ - left_) / static_cast<double>(chart_.x.categories.size());
    }
    const double half = std::max(0.5, std::min(0.36 * spacing, 32.0));
    std::string data;
    for (const Pixel& top : tops) {
      if (!std::isfinite(top.x)) continue;
      data +=
          path_data(
              {{top.x - half, zero}, {top.x - half, top.y}, {top.x + half, top.y}, {top.x + half, zero}}) +
          "z";
    }
    text_ += "<path d=\"" + data + "\" fill=\"" + colour + "\" stroke=\"none\"/>";
  }

  void draw_mark(const Mark& mark, const Scale& x, const Scale& y) {
    constexpr std::string_view halo = " paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\"";
    constexpr std::string_view dashes = " stroke-dasharray=\"2 3\"";
    if (mark.direction == Mark::Direction::horizontal) {
      line(left_, y.px(mark.at), right_, y.px(mark.at), text_colour, dashes);
      if (!mark.label.empty()) words(right_ - 4, y.px(mark.at) - 4, "end", mark.label, halo);
    } else {
      line(x.px(mark.at), upper_, x.px(mark.at), lower_, text_colour, dashes);
      // Beside its line, on the side where there is room.
      const bool fits = x.px(mark.at) + 4 + text_width(mark.label) <= right_;
      const double at = fits ? x.px(mark.at) + 4 : x.px(mark.at) - 4;
      if (!mark.label.empty()) words(at, upper_ + 11, fits ? "start" : "end", mark.label, halo);
    }
  }

  void title_and_legend() {
    if (!chart_.title.empty()) words(left_, top_ + 16, "start", chart_.title, " font-weight=\"600\"");
    double x = right_;
    for (auto s = chart_.series.rbegin(); s != chart_.series.rend(); ++s) {
      if (s->label.empty()) continue;
      x -= text_width(s->label);
      words(x, top_ + 16, "start", s->label);
      const double y = top_ + 12;
      line(x - 22, y, x - 6, y, code_of(s->colour),
           s->dashed ? " stroke-width=\"2\" stroke-dasharray=\"5 4\"" : " stroke-width=\"3\"");
      x -= 36;
    }
  }

  void axis_labels() {
    if (!chart_.x.label.empty())
      words((left_ + right_) / 2, top_ + chart_.height - 7, "middle", chart_.x.label);
    if (chart_.y.label.empty()) return;
    const double y = (upper_ + lower_) / 2;
    words(13, y, "middle", chart_.y.label, " transform=\"rotate(-90 13 " + fixed(y, 1) + ")\"");
  }

  const Chart& chart_;
  double top_;
  double left_;
  Range x_range_;
  Range y_range_;
  double right_ = 0;
  double upper_ = 0;  ///< y of the upper edge [px], smaller than lower_
  double lower_ = 0;
  std::string text_;
};

}  // namespace

std::string to_svg(const std::vector<Chart>& stacked) {
  int height = 0;
  std::string label;
  for (const Chart& chart : stacked) {
    height += chart.height;
    if (!chart.title.empty()) label += (label.empty() ? "" : "; ") + chart.title;
  }
  const int width = stacked.empty() ? 0 : stacked.front().width;
  const std::string size = std::to_string(width) + ' ' + std::to_string(height);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" +
                    std::to_string(width) + "\" height=\"" + std::to_string(height) +
                    "\" role=\"img\" aria-label=\"" + escaped(label.empty() ? "chart" : label) +
                    "\" font-family=\"system-ui,sans-serif\" font-size=\"" + fixed(font_px, 0) +
                    "\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>"
                    "<g fill=\"none\" stroke-linejoin=\"round\">";
  double left = 0;
  for (const Chart& chart : stacked) left = std::max(left, Painter(chart, 0, 0).left_margin());
  double top = 0;
  for (Chart chart : stacked) {
    chart.width = width;
    svg += Painter(chart, top, left).draw();
    top += chart.height;
  }
  return svg + "</g></svg>\n";
}

std::string to_svg(const Chart& chart) {
  return to_svg(std::vector<Chart>{chart});
}

}  // namespace softgrip::sysid
