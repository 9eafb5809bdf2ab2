#pragma once
// Models a pressure whose rate of change is limited, because the port or the pump supplies a limited flow.

#include <cmath>

#include "model/block.h"

namespace softgrip::model {

/// Computes the pressure p that follows the command u with -1 / venting_s_per_kpa <= p' <= 1 /
/// filling_s_per_kpa. The solution is exact for a linear command, because the segment is divided where the
/// pressure reaches the command. If a parameter is 0, the rate is not limited in the direction of this
/// parameter.
template <class T>
class RateLimit {
 public:
  static constexpr BlockInfo info =
      block_info("rate_limit", Station::valve, Kind::pressure, Inverse::bound, "Rate limit",
                 "The pressure follows the commanded pressure at a limited rate.",
                 "p follows u, -1 / venting_s_per_kpa <= p' <= 1 / filling_s_per_kpa");
  static constexpr std::array parameters{
      parameter("filling_s_per_kpa", "s/kPa", "shortest time in which the pressure rises by 1 kPa",
                Typical{0.005}, Within{0.0, 1000.0}, Scale{0.005}, Neutral{0.0}),
      parameter("venting_s_per_kpa", "s/kPa", "shortest time in which the pressure falls by 1 kPa",
                Typical{0.005}, Within{0.0, 1000.0}, Scale{0.005}, Neutral{0.0})};

  RateLimit(std::span<const T> values, const Preparation&)
      : filling_s_per_kpa_(values[0]), venting_s_per_kpa_(values[1]) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    const T gap = in.begin - output_;
    if (is_zero(in.duration_s))
      return pass_jump(output_, in, value_of(filling_s_per_kpa_) <= 0.0, value_of(venting_s_per_kpa_) <= 0.0,
                       next);
    if (value_of(gap) == 0.0) return follow(in, next);
    const T s_per_kpa = value_of(gap) > 0.0 ? filling_s_per_kpa_ : -venting_s_per_kpa_;
    const T meeting_s = meeting(in, gap, s_per_kpa);
    const double least_s = least_share * value_of(in.duration_s);
    if (value_of(meeting_s) <= least_s) return follow(in, next);
    if (value_of(in.duration_s - meeting_s) <= least_s) return go(in.duration_s, s_per_kpa, next);
    go(meeting_s, s_per_kpa, next);
    // `meeting_s` was computed for the straight line between the ends of the input. Therefore, the rest of
    // the input is also treated as straight. A parabola would start at a pressure that differs from the
    // output, and its mean could lie outside the range of the segment.
    follow(Segment<T>::straight(in.duration_s - meeting_s, output_, in.end), next);
  }

 private:
  /// If the pressure reaches the command within this share of the duration from either end of a segment, the
  /// segment is not divided.
  static constexpr double least_share = 1e-6;

  /// Returns the time from the start of the segment [s] at which the output reaches an input that is linear
  /// in time. If the output does not reach the input within the segment, returns the duration of the segment.
  /// `gap` is input minus output at the start of the segment [kPa]. The gap changes at the following rate
  /// [kPa/s]:
  ///
  ///     slope of the input - 1 / s_per_kpa
  static T meeting(const Segment<T>& in, const T& gap, const T& s_per_kpa) {
    if (value_of(s_per_kpa) == 0.0) return T(0.0);
    const T closing = 1.0 / s_per_kpa - (in.end - in.begin) / in.duration_s;
    if (value_of(gap) * value_of(closing) <= 0.0) return in.duration_s;
    const T meeting_s = gap / closing;
    return value_of(meeting_s) < value_of(in.duration_s) ? meeting_s : in.duration_s;
  }

  /// Moves the output at the largest permitted rate for `duration_s`.
  template <class Next>
  void go(const T& duration_s, const T& s_per_kpa, Next&& next) {
    const T begin = output_;
    output_ = begin + duration_s / s_per_kpa;
    next(Segment<T>::straight(duration_s, begin, output_));
  }

  /// Moves the output along an input that begins at the present output. If the input changes faster than the
  /// limit permits, the output moves at the largest permitted rate.
  template <class Next>
  void follow(const Segment<T>& in, Next&& next) {
    const T rise = in.end - output_;
    const T& s_per_kpa = value_of(rise) > 0.0 ? filling_s_per_kpa_ : venting_s_per_kpa_;
    if (std::abs(value_of(rise)) * value_of(s_per_kpa) > value_of(in.duration_s))
      return go(in.duration_s, value_of(rise) > 0.0 ? s_per_kpa : -s_per_kpa, next);
    const T begin = output_;
    output_ = in.end;
    next(Segment<T>{in.duration_s, begin, output_, in.mean});
  }

  T filling_s_per_kpa_, venting_s_per_kpa_;
  T output_{0.0};
};

}  // namespace softgrip::model
