#pragma once
// Applies a memoryless function to a segment.

#include "model/segment.h"

namespace softgrip::model {

/// Maps both ends of a segment. Computes the mean of the result by Simpson's rule over the parabola through
/// the segment.
/// @param begin  last output, which is the map of in.begin if the map does not change with time.
template <class T, class Map>
[[nodiscard]] Segment<T> mapped(const Segment<T>& in, Map&& map, const T& begin) {
  const T end = map(in.end);
  const T middle = map(in.at(T(0.5)));
  return {in.duration_s, begin, end, (begin + end + middle * 4.0) * (1.0 / 6.0)};
}

}  // namespace softgrip::model
