#include "sysid/pages/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "sysid/pages/canvas.h"
#include "sysid/pages/chart_scale.h"

namespace softgrip::sysid {
namespace {

constexpr double line_px = 16;       ///< height of one line of text in the title or the legend
constexpr double tick_line_px = 13;  ///< height of one text line in a tick label

/// Returns the SVG attribute of a dash pattern.
std::string_view dashes_of(Dash dash) {
  switch (dash) {
    case Dash::solid:
      return "";
    case Dash::dashed:
      return " stroke-dasharray=\"6 3\"";
    case Dash::dotted:
      return " stroke-dasharray=\"1.5 2.5\"";
  }
  return "";
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

/// Splits a text after spaces and underscores into lines of at most `most_px`. A part without a space and
/// without an underscore is not split, so its line may be wider.
std::vector<std::string> wrapped(std::string_view text, double most_px) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find_first_of(" _") + 1);
    const std::string_view next = part.empty() ? text : part;
    if (!lines.back().empty() && text_width(lines.back() + std::string(next)) > most_px) lines.emplace_back();
    lines.back() += next;
    text.remove_prefix(next.size());
  }
  return lines;
}

/// Draws one chart with its upper left corner at (edge, top).
class Painter {
 public:
  /// @param margin  distance from the left edge to the axes [px], at least left_margin().
  Painter(const Chart& chart, double edge, double top, double margin)
      : chart_(chart), edge_(edge), top_(top), left_(edge + margin) {
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

  /// Returns the width of the widest tick label of the y axis, with margins [px].
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
    grid(x, y);
    // A nested <svg> element clips the curves at the axes. A clip path is not used because it needs an id
    // that is unique in the document.
    const std::string box = fixed(left_, 1) + ' ' + fixed(upper_, 1) + ' ' + fixed(right_ - left_, 1) + ' ' +
                            fixed(lower_ - upper_, 1);
    canvas_.raw("<svg x=\"" + fixed(left_, 1) + "\" y=\"" + fixed(upper_, 1) + "\" width=\"" +
                fixed(right_ - left_, 1) + "\" height=\"" + fixed(lower_ - upper_, 1) + "\" viewBox=\"" +
                box + "\">");
    for (const Series& s : chart_.series) series(s, x, y);
    canvas_.raw("</svg>");
    for (const Mark& mark : chart_.marks) draw_mark(mark, x, y);
    title_and_legend();
    axis_labels();
    return canvas_.markup();
  }

 private:
  void lay_out() {
    right_ = edge_ + chart_.width - 14;
    upper_ = top_ + 10 + line_px * head_lines();
    std::size_t most_lines = 1;
    for (const std::string& name : chart_.x.categories)
      most_lines = std::max(most_lines, wrapped(name, name_px()).size());
    lower_ = top_ + chart_.height - (chart_.x.label.empty() ? 22 : 40) -
             tick_line_px * static_cast<double>(most_lines - 1);
  }
  /// Returns the width that is available for the name of a category [px].
  [[nodiscard]] double name_px() const {
    return (right_ - left_) / static_cast<double>(chart_.x.categories.size()) - 4;
  }
  /// Returns the number of text lines that the title and the legend need. If title and legend fit on one
  /// line, they share this line.
  [[nodiscard]] int head_lines() const {
    const double legend = legend_width();
    if (chart_.title.empty()) return legend > 0 ? 1 : 0;
    return legend > 0 && text_width(chart_.title) * 1.1 + 12 + legend > right_ - left_ ? 2 : 1;
  }
  [[nodiscard]] double legend_width() const {
    double width = 0;
    for (const Series& s : chart_.series) {
      if (!s.label.empty()) width += text_width(s.label) + 36;
    }
    return width;
  }

  void grid(const Scale& x, const Scale& y) {
    const int most_x = std::max(2, static_cast<int>((right_ - left_) / 75));
    const int most_y = std::max(3, static_cast<int>((lower_ - upper_) / 34));
    for (const Tick& tick : y.ticks(most_y)) {
      canvas_.line({left_, y.px(tick.at)}, {right_, y.px(tick.at)}, Colour::grid);
      canvas_.words({left_ - 6, y.px(tick.at) + 4}, Anchor::end, tick.text);
    }
    for (const Tick& tick : x.ticks(most_x)) {
      if (chart_.x.categories.empty()) {
        canvas_.line({x.px(tick.at), upper_}, {x.px(tick.at), lower_}, Colour::grid);
        canvas_.words({x.px(tick.at), lower_ + 15}, Anchor::middle, tick.text);
        continue;
      }
      double at = lower_ + 15;
      for (const std::string& line : wrapped(tick.text, name_px())) {
        canvas_.words({x.px(tick.at), at}, Anchor::middle, line);
        at += tick_line_px;
      }
    }
    canvas_.line({left_, lower_}, {right_, lower_}, Colour::axis);
    if (y.lower() < 0 && y.upper() > 0 && !chart_.y.logarithmic)
      canvas_.line({left_, y.px(0)}, {right_, y.px(0)}, Colour::axis);
  }

  void series(const Series& s, const Scale& x, const Scale& y) {
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
        canvas_.raw("<path d=\"" + path_data(thinned(curve)) + '"' + stroked(s.colour) + " stroke-width=\"" +
                    fixed(s.width, 1) + '"' + std::string(dashes_of(s.dash)) + "/>");
        break;
      case Series::Style::points:
        points(curve, s.colour, s.width);
        break;
      case Series::Style::band:
        band(s, curve, pixel);
        break;
      case Series::Style::bars:
        bars(s, curve, y.px(std::max(0.0, y.lower())));
        break;
    }
  }

  /// Draws each point as a stroke of length 0 with round ends. In the colours `error` and `other`, a point is
  /// a short stroke with square ends instead. The length of this stroke is above 0, because PDF renderers
  /// draw a square end only if the stroke has a direction. If there are too many points (distinct_dots()),
  /// draws the area that they cover.
  void points(const std::vector<Pixel>& curve, Colour colour, double radius) {
    const bool square = colour == Colour::error || colour == Colour::other;
    const auto dots = distinct_dots(curve);
    if (!dots) {
      canvas_.raw("<path d=\"" + path_data(ground_of(curve)) + '"' + stroked(colour) +
                  " stroke-width=\"1.1\" stroke-opacity=\"0.5\"/>");
      return;
    }
    std::string data;
    for (const Pixel& p : *dots) data += path_data({p}) + (square ? "h.1" : "h0");
    canvas_.raw("<path d=\"" + data + '"' + stroked(colour) + " stroke-linecap=\"" +
                (square ? "square" : "round") + "\" stroke-width=\"" + fixed(2 * radius, 1) + "\"/>");
  }

  template <class ToPixel>
  void band(const Series& s, const std::vector<Pixel>& lower_edge, ToPixel pixel) {
    std::vector<Pixel> upper_edge;
    for (std::size_t i = 0; i < std::min(lower_edge.size(), s.y_upper.size()); ++i) {
      upper_edge.push_back(pixel(s.x[i], s.y_upper[i]));
    }
    std::vector<Pixel> outline = thinned(lower_edge);
    const std::vector<Pixel> back = thinned(upper_edge);
    outline.insert(outline.end(), back.rbegin(), back.rend());
    std::erase_if(outline, [](const Pixel& p) { return !std::isfinite(p.x); });
    canvas_.raw("<path d=\"" + path_data(outline) + "z\"" + filled(s.colour) +
                " fill-opacity=\"0.18\" stroke=\"none\"/>");
  }

  void bars(const Series& s, const std::vector<Pixel>& tops, double zero) {
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
    canvas_.raw("<path d=\"" + data + '"' + filled(s.colour) + " stroke=\"none\"/>");
  }

  void draw_mark(const Mark& mark, const Scale& x, const Scale& y) {
    constexpr std::string_view dashes = " stroke-dasharray=\"2 3\"";
    if (mark.direction == Mark::Direction::horizontal) {
      canvas_.line({left_, y.px(mark.at)}, {right_, y.px(mark.at)}, Colour::text, dashes);
      if (!mark.label.empty())
        canvas_.words_on_curve({right_ - 4, y.px(mark.at) - 4}, Anchor::end, mark.label);
    } else {
      canvas_.line({x.px(mark.at), upper_}, {x.px(mark.at), lower_}, Colour::text, dashes);
      // The label of a line is placed on the side of the line that has enough space for the label.
      const bool fits = x.px(mark.at) + 4 + text_width(mark.label) <= right_;
      const double at = fits ? x.px(mark.at) + 4 : x.px(mark.at) - 4;
      if (!mark.label.empty())
        canvas_.words_on_curve({at, upper_ + 11}, fits ? Anchor::start : Anchor::end, mark.label);
    }
  }

  void title_and_legend() {
    if (!chart_.title.empty())
      canvas_.words({left_, top_ + 16}, Anchor::start, chart_.title, Colour::text, " font-weight=\"600\"");
    const double y = top_ + line_px * std::max(1, head_lines());
    double x = right_;
    for (auto s = chart_.series.rbegin(); s != chart_.series.rend(); ++s) {
      if (s->label.empty()) continue;
      x -= text_width(s->label);
      canvas_.words({x, y}, Anchor::start, s->label);
      canvas_.line({x - 26, y - 4}, {x - 6, y - 4}, s->colour,
                   " stroke-width=\"2.4\"" + std::string(dashes_of(s->dash)));
      x -= 36;
    }
  }

  void axis_labels() {
    if (!chart_.x.label.empty())
      canvas_.words({(left_ + right_) / 2, top_ + chart_.height - 7}, Anchor::middle,
                    in_words(chart_.x.label));
    if (chart_.y.label.empty()) return;
    const double x = edge_ + 13;
    const double y = (upper_ + lower_) / 2;
    canvas_.words({x, y}, Anchor::middle, in_words(chart_.y.label), Colour::text,
                  " transform=\"rotate(-90 " + fixed(x, 1) + ' ' + fixed(y, 1) + ")\"");
  }

  const Chart& chart_;
  double edge_;
  double top_;
  double left_;
  Range x_range_;
  Range y_range_;
  double right_ = 0;
  double upper_ = 0;  ///< y coordinate of the upper edge [px]; smaller than lower_
  double lower_ = 0;
  Canvas canvas_;
};

}  // namespace

Extent extent_of(const ChartRows& rows) {
  Extent extent;
  for (const auto& row : rows) {
    Extent of_row;
    for (const Chart& chart : row) {
      of_row.width += chart.width;
      of_row.height = std::max(of_row.height, chart.height);
    }
    extent.width = std::max(extent.width, of_row.width);
    extent.height += of_row.height;
  }
  return extent;
}

std::string markup_of(const ChartRows& rows) {
  std::string markup;
  std::vector<double> margins;  // left margin of each column of charts [px]
  for (const auto& row : rows) {
    margins.resize(std::max(margins.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i)
      margins[i] = std::max(margins[i], Painter(row[i], 0, 0, 0).left_margin());
  }
  double top = 0;
  for (const auto& row : rows) {
    double edge = 0;
    double height = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      markup += Painter(row[i], edge, top, margins[i]).draw();
      edge += row[i].width;
      height = std::max(height, static_cast<double>(row[i].height));
    }
    top += height;
  }
  return markup;
}

Chart chart_over(std::vector<std::string> names) {
  Chart chart;
  chart.height = 220;
  chart.x.lower = -0.5;
  chart.x.upper = static_cast<double>(names.size()) - 0.5;
  chart.x.categories = std::move(names);
  return chart;
}

Series points_over_names(std::string label, Colour colour, std::vector<double> values) {
  Series points;
  points.label = std::move(label);
  points.colour = colour;
  points.style = Series::Style::points;
  points.width = 4;
  for (std::size_t i = 0; i < values.size(); ++i) points.x.push_back(static_cast<double>(i));
  points.y = std::move(values);
  return points;
}

ChartRows stacked(std::vector<Chart> charts) {
  ChartRows rows;
  rows.reserve(charts.size());
  for (Chart& chart : charts) rows.push_back({std::move(chart)});
  return rows;
}

}  // namespace softgrip::sysid
