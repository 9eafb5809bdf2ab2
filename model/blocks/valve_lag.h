#pragma once
// Models the lag of the regulator and the tube as a first-order lag of the pressure p: tau p' = command - p
// with the time constant tau.

#include <cmath>

#include "model/block.h"
#include "model/exponential.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Computes the pressure behind the lag. The solution is exact for a straight command, also if the pressure
/// reverses. Where the pressure becomes equal to the command within a segment, the pressure has an extremum.
/// In this case, the block passes two segments on.
template <class T>
class ValveLag {
 public:
  static constexpr BlockInfo info =
      block_info("valve_lag", Station::valve, Kind::pressure, Inverse::lead, "Valve lag",
                 "First-order lag of the regulator and the tube.", "tau p' = u - p");
  static constexpr std::array parameters{parameter("time_constant_s", "s", "time constant of the lag",
                                                   Typical{0.05}, Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0},
                                                   Latency{})};

  ValveLag(std::span<const T> values, const Preparation& preparation)
      : lag_(values[0], preparation.sample_time_s) {}

  void reset(const T& input) { output_ = input; }
  [[nodiscard]] T output() const { return output_; }
  [[nodiscard]] const T& time_constant_s() const { return lag_.time_constant_s(); }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (lag_.passes()) {
      output_ = in.end;
      next(in);
      return;
    }
    if (is_zero(in.duration_s)) return;  // a jump of the command does not change the pressure immediately
    const ExponentialWeights<T>& w = lag_.at(in.duration_s);
    const T bend = in.bend();
    const T begin = output_;
    const T end = w.end(begin, in, bend);
    output_ = end;
    const T gap_begin = in.begin - begin;
    const T gap_end = in.end - end;
    if (value_of(gap_begin) * value_of(gap_end) < 0.0 && turns(in, begin, gap_begin, end, next)) return;
    next(Segment<T>{in.duration_s, begin, end, w.mean(begin, in, bend)});
  }

 private:
  // For a straight input of slope r, the gap d = input - output follows d' = r - d / tau. The gap is zero
  // after t = tau log(1 - d(0) / (r tau)). A reversal is ignored if its distance from an end of the segment
  // is below a millionth of the segment's duration. The effect of such a reversal on a Bouc-Wen block is of
  // second order in its distance from the end.
  template <class Next>
  bool turns(const Segment<T>& in, const T& begin, const T& gap_begin, const T& end, Next&& next) const {
    using std::log1p;
    const T& time_constant_s = lag_.time_constant_s();
    const T slope = (in.end - in.begin) / in.duration_s;
    const T turn_s = time_constant_s * log1p(-gap_begin / (slope * time_constant_s));
    const T rest_s = in.duration_s - turn_s;
    const double least_s = 1e-6 * value_of(in.duration_s);
    if (!(value_of(turn_s) > least_s && value_of(rest_s) > least_s)) return false;
    const T peak = in.begin + slope * turn_s;
    next(
        Segment<T>{turn_s, begin, peak, (in.begin + peak) * 0.5 - time_constant_s * (peak - begin) / turn_s});
    next(Segment<T>{rest_s, peak, end, (peak + in.end) * 0.5 - time_constant_s * (end - peak) / rest_s});
    return true;
  }

  LagWeights<T> lag_;
  T output_{0.0};
};

}  // namespace softgrip::model
