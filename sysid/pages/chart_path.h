#pragma once
// Converts curves to SVG path data and removes points that the resolution of a picture cannot show.

#include <optional>
#include <string>
#include <vector>

namespace softgrip::sysid {

/// A point in pixels. A point that is not finite interrupts the curve.
struct Pixel {
  double x;
  double y;
};

/// Removes the points of a curve that a reader cannot see. If x increases throughout, the lowest and the
/// highest point of each pixel column are kept in their order; if a column has at most four points, all of
/// them are kept. Otherwise the points are rounded to a grid of 1/3 pixel, and repeated points and strokes
/// are removed. If too many strokes remain, points less than 2 pixels from the last kept point are removed.
/// If the number of strokes is still too large, the result is the area that the points cover.
[[nodiscard]] std::vector<Pixel> thinned(const std::vector<Pixel>& curve);

/// Returns vertical strokes in adjacent pixel columns that cover the area of a cloud of points.
[[nodiscard]] std::vector<Pixel> ground_of(const std::vector<Pixel>& cloud);

/// Rounds points that are drawn as dots to a grid of 0.5 pixel. Removes repeated dots and dots that are not
/// finite. If a reader could not distinguish the remaining number of dots from a filled area, returns
/// nullopt.
[[nodiscard]] std::optional<std::vector<Pixel>> distinct_dots(const std::vector<Pixel>& dots);

/// Returns SVG path data such as "M1.5 2l3 4...", which consist of relative moves with a resolution of 0.1
/// pixel.
[[nodiscard]] std::string path_data(const std::vector<Pixel>& curve);

}  // namespace softgrip::sysid
