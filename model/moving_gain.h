#pragma once
// A signal multiplied by a gain that moves with its surroundings.

#include "model/segment.h"

namespace softgrip::model {

/// Multiplies segments by a gain that goes linearly from where it was to where the surroundings put it at the
/// end of the sample. Within a sample of several segments the gain moves in the first.
template <class T>
class MovingGain {
 public:
  void reset(const T& gain) { gain_ = gain; }

  Segment<T> step(const Segment<T>& in, const T& gain) {
    const Segment<T> out{
        in.duration_s, in.begin * gain_, in.end * gain,
        in.mean * ((gain_ + gain) * 0.5) + (in.end - in.begin) * (gain - gain_) * (1.0 / 12.0)};
    gain_ = gain;
    return out;
  }

 private:
  T gain_{1.0};
};

}  // namespace softgrip::model
