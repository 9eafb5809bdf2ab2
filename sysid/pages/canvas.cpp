#include "sysid/pages/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_set>

#include "base/numbers.h"
#include "base/result/table.h"

namespace softgrip::sysid {
namespace {

constexpr double lifted = std::numeric_limits<double>::quiet_NaN();

bool drawn(const Pixel& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

bool x_increases(const std::vector<Pixel>& curve) {
  double last = -std::numeric_limits<double>::infinity();
  for (const Pixel& p : curve) {
    if (!drawn(p)) continue;
    if (p.x < last) return false;
    last = p.x;
  }
  return true;
}

/// Largest numbers of strokes and dots of a curve. If there were more, a reader could not distinguish the
/// curve from a filled area.
constexpr std::size_t most_strokes = 9000;
constexpr std::size_t most_dots = 6000;

/// Appends the lowest and the highest of the points [begin, end), in their order in the curve. All these
/// points are in one pixel column. If there are at most four points, all of them are appended.
void append_column(const std::vector<Pixel>& curve, std::size_t begin, std::size_t end,
                   std::vector<Pixel>& kept) {
  if (end - begin <= 4) {
    kept.insert(kept.end(), curve.begin() + static_cast<std::ptrdiff_t>(begin),
                curve.begin() + static_cast<std::ptrdiff_t>(end));
    return;
  }
  std::size_t lowest = begin;
  std::size_t highest = begin;
  for (std::size_t i = begin; i < end; ++i) {
    if (curve[i].y < curve[lowest].y) lowest = i;
    if (curve[i].y > curve[highest].y) highest = i;
  }
  kept.push_back(curve[std::min(lowest, highest)]);
  if (lowest != highest) kept.push_back(curve[std::max(lowest, highest)]);
}

std::vector<Pixel> thinned_by_column(const std::vector<Pixel>& curve) {
  std::vector<Pixel> kept;
  for (std::size_t begin = 0; begin < curve.size();) {
    if (!drawn(curve[begin])) {
      if (!kept.empty() && drawn(kept.back())) kept.push_back({lifted, lifted});
      ++begin;
      continue;
    }
    std::size_t end = begin + 1;
    while (end < curve.size() && drawn(curve[end]) && std::floor(curve[end].x) == std::floor(curve[begin].x))
      ++end;
    append_column(curve, begin, end, kept);
    begin = end;
  }
  return kept;
}

/// Rounds the points to a grid of 1/3 pixel. Removes points whose distance from the last kept point is at
/// most `least_px`, and strokes that were already drawn.
std::vector<Pixel> thinned_by_stroke(const std::vector<Pixel>& curve, double least_px) {
  constexpr double grid = 1.0 / 3.0;
  std::vector<Pixel> kept;
  std::unordered_set<std::uint64_t> strokes;
  std::int64_t last_x = 0;
  std::int64_t last_y = 0;
  bool pen_down = false;
  for (const Pixel& p : curve) {
    if (!drawn(p)) {
      pen_down = false;
      continue;
    }
    const auto x = static_cast<std::int64_t>(std::lround(p.x / grid));
    const auto y = static_cast<std::int64_t>(std::lround(p.y / grid));
    const auto far_px = grid * std::hypot(static_cast<double>(x - last_x), static_cast<double>(y - last_y));
    if (pen_down && far_px <= least_px) continue;
    const Pixel here{static_cast<double>(x) * grid, static_cast<double>(y) * grid};
    if (!pen_down) {
      if (!kept.empty()) kept.push_back({lifted, lifted});
      kept.push_back(here);
    } else {
      const auto pack = [](std::int64_t a) { return static_cast<std::uint64_t>(a) & 0xffffU; };
      const std::uint64_t there = pack(last_x) << 16U | pack(last_y);
      const std::uint64_t now = pack(x) << 16U | pack(y);
      if (strokes.insert(std::max(there, now) << 32U | std::min(there, now)).second) {
        const Pixel from{static_cast<double>(last_x) * grid, static_cast<double>(last_y) * grid};
        if (kept.back().x != from.x || kept.back().y != from.y) {
          kept.push_back({lifted, lifted});
          kept.push_back(from);
        }
        kept.push_back(here);
      }
    }
    last_x = x;
    last_y = y;
    pen_down = true;
  }
  return kept;
}

/// Returns vertical strokes that cover the area of the points. In each pixel column, neighbouring points that
/// are at most `gap` apart share one stroke.
std::vector<Pixel> covered(const std::vector<Pixel>& curve, double gap) {
  constexpr double dot = 0.7;  // length of the stroke that covers a single point
  std::vector<Pixel> cloud;
  for (const Pixel& p : curve) {
    if (drawn(p)) cloud.push_back({std::floor(p.x) + 0.5, p.y});
  }
  std::sort(cloud.begin(), cloud.end(),
            [](const Pixel& a, const Pixel& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Pixel> kept;
  for (std::size_t begin = 0; begin < cloud.size();) {
    std::size_t end = begin + 1;
    while (end < cloud.size() && cloud[end].x == cloud[begin].x && cloud[end].y - cloud[end - 1].y <= gap)
      ++end;
    if (!kept.empty()) kept.push_back({lifted, lifted});
    kept.push_back({cloud[begin].x, cloud[begin].y - dot / 2});
    kept.push_back({cloud[begin].x, cloud[end - 1].y + dot / 2});
    begin = end;
  }
  return kept;
}

void append_tenths(std::string& text, std::int64_t tenths) {
  if (tenths < 0) text += '-';
  const std::int64_t magnitude = tenths < 0 ? -tenths : tenths;
  if (magnitude >= 10 || magnitude == 0) text += std::to_string(magnitude / 10);
  if (magnitude % 10 != 0) text += '.' + std::to_string(magnitude % 10);
}

constexpr double character_px = 6.4;

std::string_view name_of(Anchor anchor) {
  return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}

std::string place(double x, double y, double width, double height) {
  return "<rect x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" width=\"" +
         fixed(std::max(0.0, width), 1) + "\" height=\"" + fixed(std::max(0.0, height), 1) + '"';
}

std::string text_at(Pixel at, Anchor anchor, std::string_view text, std::string_view attributes) {
  return "<text x=\"" + fixed(at.x, 1) + "\" y=\"" + fixed(at.y, 1) + "\" text-anchor=\"" +
         std::string(name_of(anchor)) + '"' + std::string(attributes) + '>' + result::escaped(text) +
         "</text>";
}

}  // namespace

std::vector<Pixel> thinned(const std::vector<Pixel>& curve) {
  if (x_increases(curve)) return thinned_by_column(curve);
  for (const double least_px : {0.0, 2.0}) {
    std::vector<Pixel> kept = thinned_by_stroke(curve, least_px);
    if (kept.size() <= most_strokes) return kept;
  }
  return ground_of(curve);
}

std::vector<Pixel> ground_of(const std::vector<Pixel>& cloud) {
  std::vector<Pixel> kept = covered(cloud, 1);
  for (double gap = 2; kept.size() > most_strokes && gap < 100; gap *= 2) kept = covered(cloud, gap);
  return kept;
}

std::optional<std::vector<Pixel>> distinct_dots(const std::vector<Pixel>& dots) {
  constexpr double grid = 0.5;
  std::vector<Pixel> kept;
  for (const Pixel& p : dots) {
    if (drawn(p)) kept.push_back({std::round(p.x / grid) * grid, std::round(p.y / grid) * grid});
  }
  std::sort(kept.begin(), kept.end(),
            [](const Pixel& a, const Pixel& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  kept.erase(std::unique(kept.begin(), kept.end(),
                         [](const Pixel& a, const Pixel& b) { return a.x == b.x && a.y == b.y; }),
             kept.end());
  if (kept.size() > most_dots) return std::nullopt;
  return kept;
}

std::string path_data(const std::vector<Pixel>& curve) {
  std::string text;
  std::int64_t last_x = 0;
  std::int64_t last_y = 0;
  bool pen_down = false;
  for (const Pixel& p : curve) {
    if (!drawn(p)) {
      pen_down = false;
      continue;
    }
    const auto x = static_cast<std::int64_t>(std::lround(10 * p.x));
    const auto y = static_cast<std::int64_t>(std::lround(10 * p.y));
    text += pen_down ? 'l' : 'M';
    append_tenths(text, pen_down ? x - last_x : x);
    const std::int64_t dy = pen_down ? y - last_y : y;
    if (dy >= 0) text += ' ';
    append_tenths(text, dy);
    last_x = x;
    last_y = y;
    pen_down = true;
  }
  return text;
}

double text_width(std::string_view text) {
  const auto characters = std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80; });
  return character_px * static_cast<double>(characters);
}

void Canvas::line(Pixel from, Pixel to, Colour colour, std::string_view more) {
  markup_ += "<path d=\"" + path_data({from, to}) + '"' + stroked(colour) + std::string(more) + "/>";
}

void Canvas::box(double x, double y, double width, double height, Colour fill, std::string_view more) {
  markup_ += place(x, y, width, height) + filled(fill) + std::string(more) + "/>";
}

void Canvas::framed_box(double x, double y, double width, double height, Colour fill, Colour edge,
                        std::string_view more) {
  markup_ += place(x, y, width, height) + filled(fill, edge) + std::string(more) + "/>";
}

void Canvas::words(Pixel at, Anchor anchor, std::string_view text, Colour colour, std::string_view more) {
  markup_ += text_at(at, anchor, text, filled(colour) + std::string(more));
}

void Canvas::words_on_curve(Pixel at, Anchor anchor, std::string_view text) {
  markup_ += text_at(at, anchor, text,
                     filled(Colour::text, Colour::paper) + " paint-order=\"stroke\" stroke-width=\"3\"");
}

}  // namespace softgrip::sysid
