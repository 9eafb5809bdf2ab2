#pragma once
// Curves as SVG path data, thinned to what a picture can show.

#include <string>
#include <vector>

namespace softgrip::sysid {

/// A point in pixels; not finite: the pen is lifted.
struct Pixel {
  double x;
  double y;
};

/// Keeps what is visible of a curve. Where x increases throughout: per pixel column the first, the lowest,
/// the highest and the last point, in their order. Otherwise: points on a grid of a third of a pixel,
/// without repeated ones and without strokes that were drawn already.
[[nodiscard]] std::vector<Pixel> thinned(const std::vector<Pixel>& curve);

/// "M1.5 2l3 4...": relative moves in tenths of pixels.
[[nodiscard]] std::string path_data(const std::vector<Pixel>& curve);

}  // namespace softgrip::sysid
