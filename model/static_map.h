#pragma once
// Applies a memoryless function to a segment.

#include "model/segment.h"

namespace softgrip::model {

/// Returns the segment that results if a function is applied to a segment. The function is applied to both
/// ends. The mean of the result is computed by Simpson's rule over the parabola of the segment.
/// @param begin  last output; equal to map(in.begin) if the function does not change with time.
template <class T, class Map>
[[nodiscard]] Segment<T> mapped(const Segment<T>& in, Map&& map, const T& begin) {
  const T end = map(in.end);
  const T middle = map(in.at(T(0.5)));
  return {in.duration_s, begin, end, (begin + end + middle * 4.0) * (1.0 / 6.0)};
}

}  // namespace softgrip::model
