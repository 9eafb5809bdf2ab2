#pragma once
// The gain of the actuator drifts across a campaign: with time, while it runs in, or with use.

#include "model/block.h"
#include "model/gain.h"
#include "model/moving_gain.h"

namespace softgrip::model {

/// y times 1 + a t + r (1 - exp(-t/tau)) + c l, kept positive; t is the time of the campaign, l the way that
/// the actuator has gone in it, up and down. Runs through a campaign: rest() keeps l, only reset() forgets
/// it.
template <class T>
class Ageing {
 public:
  static constexpr BlockInfo info{.id = "ageing",
                                  .station = Station::actuator,
                                  .kind = Kind::displacement,
                                  .inverse = Inverse::implicit,
                                  .title = "Ageing",
                                  .meaning = "The gain drifts with the time of the campaign or with use.",
                                  .equation =
                                      "z = y (1 + gain t + run_in (1 - exp(-t/tau)) + use l), l = way gone "
                                      "so far; kept positive"};
  static constexpr std::array parameters{
      ParameterSpec{.name = "gain_per_h",
                    .unit = "1/h",
                    .default_value = 0.1,
                    .lower = -1000.0,
                    .upper = 1000.0,
                    .scale = 0.1,
                    .meaning = "relative gain won per hour",
                    .neutral = 0.0},
      ParameterSpec{.name = "run_in",
                    .unit = "",
                    .default_value = 0.05,
                    .lower = -10.0,
                    .upper = 10.0,
                    .scale = 0.05,
                    .meaning = "relative gain won in the course of running in",
                    .neutral = 0.0,
                    .if_left_out = 0.0},
      ParameterSpec{.name = "run_in_time_s",
                    .unit = "s",
                    .default_value = 60.0,
                    .lower = 0.1,
                    .upper = 1e5,
                    .scale = 30.0,
                    .meaning = "time constant of running in",
                    .if_left_out = 60.0},
      ParameterSpec{.name = "gain_per_m",
                    .unit = "1/m",
                    .default_value = 0.05,
                    .lower = -1000.0,
                    .upper = 1000.0,
                    .scale = 0.05,
                    .meaning = "relative gain won per metre of way gone",
                    .neutral = 0.0,
                    .if_left_out = 0.0}};

  Ageing(std::span<const T> values, const Preparation&)
      : gain_per_h_(values[0]), run_in_(values[1]), run_in_per_s_(1.0 / values[2]), gain_per_m_(values[3]) {}

  void reset(const T& input) {
    way_mm_ = T(0.0);
    rest(input);
  }
  void rest(const T& input) {
    // Where the time of the campaign puts it, the next step says; what use has added stands.
    gain_.reset(positive_gain(T(gain_per_m_ * way_mm_ * 1e-3)));
    input_mm_ = input;
    output_ = input;
  }
  [[nodiscard]] T output() const { return output_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings& surroundings, Next&& next) {
    way_mm_ = way_to(in.end);
    input_mm_ = in.end;
    const Segment<T> out = gain_.step(in, at(way_mm_, surroundings));
    output_ = out.end;
    next(out);
  }

  template <class U>
  [[nodiscard]] U peek(const T&, const U& end_mm, const Surroundings& surroundings) const {
    return end_mm * at(way_to(end_mm), surroundings);
  }

 private:
  template <class U>
  [[nodiscard]] U way_to(const U& end_mm) const {
    const U change = end_mm - input_mm_;
    return way_mm_ + (value_of(change) < 0.0 ? U(-change) : change);
  }

  template <class U>
  [[nodiscard]] U at(const U& way_mm, const Surroundings& surroundings) const {
    using std::expm1;
    const double t = surroundings.time_s;
    const T with_time = gain_per_h_ * (t / 3600.0) - run_in_ * expm1(T(run_in_per_s_ * -t));
    return positive_gain(U(gain_per_m_ * way_mm * 1e-3 + with_time));
  }

  T gain_per_h_;
  T run_in_;
  T run_in_per_s_;
  T gain_per_m_;
  T way_mm_{0.0};  // l, in mm
  T input_mm_{0.0};
  MovingGain<T> gain_;
  T output_{0.0};
};

}  // namespace softgrip::model
