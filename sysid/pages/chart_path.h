#pragma once
// Curves as SVG path data, thinned to what a picture can show.

#include <optional>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// A point in pixels; not finite: the pen is lifted.
struct Pixel {
  double x;
  double y;
};

/// Keeps what is visible of a curve. Where x increases throughout: per pixel column the lowest and the
/// highest point, in their order, and where there are no more than four, all. Otherwise: points on a grid of
/// a third of a pixel, without repeated ones and without strokes that were drawn already; where these are
/// too many, points two pixels apart; of a cloud, where these are too, the ground that it covers.
[[nodiscard]] std::vector<Pixel> thinned(const std::vector<Pixel>& curve);

/// The ground that a cloud of points covers, as upright strokes, one pixel column beside the other.
[[nodiscard]] std::vector<Pixel> ground_of(const std::vector<Pixel>& cloud);

/// Dots on a grid of half a pixel, each once; those that are not finite are left out. Nothing where they are
/// so many that only the ground can be seen that they cover.
[[nodiscard]] std::optional<std::vector<Pixel>> distinct_dots(const std::vector<Pixel>& dots);

/// "M1.5 2l3 4...": relative moves in tenths of pixels.
[[nodiscard]] std::string path_data(const std::vector<Pixel>& curve);

}  // namespace softgrip::sysid
