#pragma once
// Limits a monotone segment to a level. A segment that crosses the level is divided at the crossing.

#include "model/segment.h"

namespace softgrip::model {

/// Returns the number with the smaller value. The derivatives of the two numbers are not compared.
template <class T>
[[nodiscard]] T lesser(const T& x, const T& y) {
  return value_of(y) < value_of(x) ? y : x;
}

/// Returns the number with the larger value. The derivatives of the two numbers are not compared.
template <class T>
[[nodiscard]] T greater(const T& x, const T& y) {
  return value_of(y) > value_of(x) ? y : x;
}

/// Passes on the smaller of `in` and `level`. If `in` crosses the level within the segment, two segments are
/// passed on.
template <class T, class Next>
void clip_above(const Segment<T>& in, const T& level, Next&& next) {
  const double top = value_of(level);
  const double begin = value_of(in.begin);
  const double end = value_of(in.end);
  if (begin <= top && end <= top) {
    next(in);
  } else if (begin >= top && end >= top) {
    next(Segment<T>{in.duration_s, level, level, level});
  } else {
    const T fraction = in.fraction_at(level);
    if (end > top) {
      Segment<T> rise = in.before(fraction);
      rise.end = level;
      next(rise);
      next(Segment<T>{in.duration_s - rise.duration_s, level, level, level});
    } else {
      Segment<T> fall = in.beyond(fraction);
      fall.begin = level;
      next(Segment<T>{in.duration_s - fall.duration_s, level, level, level});
      next(fall);
    }
  }
}

}  // namespace softgrip::model
