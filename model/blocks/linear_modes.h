#pragma once
// Models linear dynamics of any kind: several modes of second order in parallel. Their gains have either
// sign, so that the sum may have zeros, an inverse response, a negative gain or no static gain.

#include <cstddef>
#include <numbers>
#include <vector>

#include "model/block.h"
#include "model/second_order.h"

namespace softgrip::model {

/// Computes the sum of a direct response and of modes. In the mode i with the angular frequency w = 2 pi /
/// period, the pressure p moves a second-order system z with the damping ratio d. The mode adds gain z + lead
/// z'/w to the displacement. The solution is exact if p is a parabola over each segment. All modes are
/// stable.
template <class T>
class LinearModes {
 public:
  static constexpr BlockInfo info =
      block_info("linear_modes", Station::actuator, Kind::element, Inverse::none, "Linear modes",
                 "Linear dynamics: second-order modes in parallel, with positive or negative gains.",
                 "y += direct p + sum(gain z + lead z'/w), z'' + 2 d w z' + w^2 z = w^2 p, w = 2 pi/period");
  static constexpr std::array parameters{
      parameter("direct_mm_per_kpa", "mm/kPa", "gain of the immediate response", Typical{0.1},
                Within{-1e4, 1e4}, Scale{0.1}, Neutral{0.0}, PerPressure{})};
  static constexpr std::array repeated{
      parameter("period#_s", "s", "2 pi divided by the angular frequency of mode #", Typical{0.5},
                Within{1e-6, 1e6}, Scale{0.2}, Latency{}),
      parameter("damping_ratio#", "",
                "damping ratio d of mode #; a mode with d of 1 or more has two real poles", Typical{0.3},
                Within{0.005, 100}, Scale{0.1}),
      parameter("gain#_mm_per_kpa", "mm/kPa", "static gain of mode #", Typical{0.05}, Within{-1e4, 1e4},
                Scale{0.1}, Neutral{0.0}, PerPressure{}),
      parameter("lead#_mm_per_kpa", "mm/kPa",
                "gain of mode # for z'/w, the rate of change of z divided by the angular frequency w",
                Typical{-0.05}, Within{-1e4, 1e4}, Scale{0.1}, Neutral{0.0}, PerPressure{})};
  static constexpr std::size_t min_parts = 0;
  static constexpr std::size_t max_parts = 4;

  LinearModes(std::span<const T> values, const Preparation&) : direct_(values[0]) {
    for (std::size_t i = 1; i + 3 < values.size(); i += 4)
      modes_.push_back(
          {{T(2.0 * std::numbers::pi / values[i]), values[i + 1]}, values[i + 2], values[i + 3]});
  }

  void reset(const T& input) {
    for (Mode& mode : modes_) mode.system.reset(input);
    output_ = sum(input);
  }
  [[nodiscard]] T output() const { return output_; }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T begin = output_;
    if (!(value_of(in.duration_s) > 0.0)) {
      output_ = sum(in.end);
      return Segment<T>::straight(in.duration_s, begin, output_);
    }
    T mean = direct_ * in.mean;
    for (Mode& mode : modes_) {
      const T from = mode.system.value();
      mean += mode.gain * mode.system.advance(in);
      mean += mode.lead * (mode.system.value() - from) / (mode.system.omega() * in.duration_s);
    }
    output_ = sum(in.end);
    return {in.duration_s, begin, output_, mean};
  }

 private:
  struct Mode {
    SecondOrder<T> system;
    T gain, lead;
  };

  [[nodiscard]] T sum(const T& pressure_kpa) const {
    T result = direct_ * pressure_kpa;
    for (const Mode& mode : modes_)
      result += mode.gain * mode.system.value() + mode.lead * mode.system.rate() / mode.system.omega();
    return result;
  }

  T direct_;
  T output_{0.0};
  std::vector<Mode> modes_;
};

}  // namespace softgrip::model
