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

/// Removes the points of a curve that are not visible. If x increases throughout, the lowest and the highest
/// point of each pixel column are kept in their order; if a column has at most four points, all are kept.
/// Otherwise the points are rounded to a grid of 1/3 pixel, and repeated points and strokes are removed. If
/// too many strokes remain, points less than 2 pixels apart are removed. If there are still too many strokes,
/// the result is the area that the points cover.
[[nodiscard]] std::vector<Pixel> thinned(const std::vector<Pixel>& curve);

/// Returns the area that a cloud of points covers, as vertical strokes in adjacent pixel columns.
[[nodiscard]] std::vector<Pixel> ground_of(const std::vector<Pixel>& cloud);

/// Rounds points that are drawn as dots to a grid of 0.5 pixel. Removes repeated dots and dots that are not
/// finite. Returns nullopt if there are too many dots for a reader to distinguish them from the area that
/// they cover.
[[nodiscard]] std::optional<std::vector<Pixel>> distinct_dots(const std::vector<Pixel>& dots);

/// Returns SVG path data such as "M1.5 2l3 4...": relative moves with a resolution of 0.1 pixel.
[[nodiscard]] std::string path_data(const std::vector<Pixel>& curve);

}  // namespace softgrip::sysid
