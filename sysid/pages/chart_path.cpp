#include "sysid/pages/chart_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>

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

/// Appends first, lowest, highest, last of [begin, end), all in one column, each once, in their order.
void append_column(const std::vector<Pixel>& curve, std::size_t begin, std::size_t end,
                   std::vector<Pixel>& kept) {
  std::size_t lowest = begin;
  std::size_t highest = begin;
  for (std::size_t i = begin; i < end; ++i) {
    if (curve[i].y < curve[lowest].y) lowest = i;
    if (curve[i].y > curve[highest].y) highest = i;
  }
  std::size_t last = end;  // none yet
  for (const std::size_t i : {begin, std::min(lowest, highest), std::max(lowest, highest), end - 1}) {
    if (i != last) kept.push_back(curve[i]);
    last = i;
  }
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

std::vector<Pixel> thinned_by_stroke(const std::vector<Pixel>& curve) {
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
    if (pen_down && x == last_x && y == last_y) continue;
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

void append_tenths(std::string& text, std::int64_t tenths) {
  if (tenths < 0) text += '-';
  const std::int64_t magnitude = tenths < 0 ? -tenths : tenths;
  if (magnitude >= 10 || magnitude == 0) text += std::to_string(magnitude / 10);
  if (magnitude % 10 != 0) text += '.' + std::to_string(magnitude % 10);
}

}  // namespace

std::vector<Pixel> thinned(const std::vector<Pixel>& curve) {
  return x_increases(curve) ? thinned_by_column(curve) : thinned_by_stroke(curve);
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

}  // namespace softgrip::sysid
