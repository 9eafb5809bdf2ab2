#pragma once
// Implements blocks whose output is a function of the present input only.

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

/// A displacement block whose output depends only on the present input. `Block` declares the function
/// template `U map(const U& y) const`.
template <class Block, class T>
class StaticMapBlock {
 public:
  void reset(const T& input) { output_ = at(input); }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const Segment<T> out = mapped(
        in, [this](const T& y) { return at(y); }, output_);
    output_ = out.end;
    next(out);
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_mm, const Surroundings&) const {
    return at(end_mm);
  }

 private:
  template <class U>
  [[nodiscard]] U at(const U& y) const {
    return static_cast<const Block*>(this)->map(y);
  }

  T output_{0.0};
};

}  // namespace softgrip::model
