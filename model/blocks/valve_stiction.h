#pragma once
// Models stick-slip motion of the valve. The cause is stiction of its spool, or the dead band of a digital
// regulator.

#include <cmath>

#include "model/block.h"

namespace softgrip::model {

/// Keeps the pressure constant until the command differs from the pressure by more than the band. The
/// pressure then jumps to the command and stays constant again. As a result, a ramp of the command becomes a
/// series of steps of the pressure. The block models the stiction of positioners (stick band equal to slip
/// jump: Choudhury, Thornhill and Shah, Control Engineering Practice 13, 2005) and the dead band of digital
/// regulators. All jumps within a segment are passed on at their exact times. If the command crosses one band
/// in less than `rest_s`, the spool does not come to rest between the jumps. In this case, the valve follows
/// the command to the end of the segment.
template <class T>
class ValveStiction {
 public:
  static constexpr BlockInfo info =
      block_info("valve_stiction", Station::valve, Kind::pressure, Inverse::ignored, "Valve stiction",
                 "The valve sticks until the commanded pressure differs from the pressure by more than a "
                 "band. When the valve moves, the pressure jumps to the commanded pressure.",
                 "p stays until |u - p| > band, then p = u");
  static constexpr std::array parameters{parameter(
      "band_kpa", "kPa", "difference between commanded pressure and pressure at which the pressure jumps",
      Typical{1.0}, Within{0.0, 1000.0}, Scale{0.5}, Neutral{0.0})};
  /// Shortest time in which a spool can move and come to rest again [s].
  static constexpr double rest_s = 2e-3;

  ValveStiction(std::span<const T> values, const Preparation&) : band_(values[0]) {}

  void reset(const T& input) {
    moving_ = false;
    held_ = value_of(band_) > 0.0 ? T(std::trunc(value_of(input) / value_of(band_)) * band_) : input;
  }
  [[nodiscard]] T output() const { return held_; }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (is_followed(in)) {
      follow(in, next);
    } else {
      climb(in, next);
    }
  }

 private:
  [[nodiscard]] static bool rises(const Segment<T>& in) { return value_of(in.end) > value_of(in.begin); }

  [[nodiscard]] bool is_followed(const Segment<T>& in) const {
    const double change = std::abs(value_of(in.end) - value_of(in.begin));
    return change * rest_s > value_of(band_) * value_of(in.duration_s);
  }

  /// Returns the command at which the spool starts to move: upwards if `up` is true, otherwise downwards.
  [[nodiscard]] T level(bool up) const { return up ? T(held_ + band_) : T(held_ - band_); }
  [[nodiscard]] static bool is_beyond(const T& command, const T& level, bool up) {
    return up ? value_of(command) > value_of(level) : value_of(command) < value_of(level);
  }

  template <class Next>
  void jump(const T& to, Next& next) {
    if (same(to, held_)) return;
    next(Segment<T>{T(0.0), held_, to, (held_ + to) * 0.5});
    held_ = to;
  }
  template <class Next>
  void stay(const T& duration_s, Next& next) const {
    next(Segment<T>{duration_s, held_, held_, held_});
  }

  // Makes the valve follow a command that is so fast that the spool does not stick again.
  template <class Next>
  void follow(const Segment<T>& in, Next& next) {
    const bool up = rises(in);
    const bool goes_on = moving_ && up == upwards_;
    const T start = level(up);
    if (!goes_on && !is_beyond(in.end, start, up)) {
      moving_ = false;
      stay(in.duration_s, next);
      return;
    }
    moving_ = true;
    upwards_ = up;
    Segment<T> rest = in;
    if (!goes_on && is_beyond(start, in.begin, up)) {
      rest = in.beyond(in.fraction_at(start));
      stay(T(in.duration_s - rest.duration_s), next);
    }
    jump(rest.begin, next);
    held_ = rest.end;
    next(rest);
  }

  // Passes on a series of jumps: the pressure jumps each time the command has moved by one band.
  template <class Next>
  void climb(const Segment<T>& in, Next& next) {
    moving_ = false;
    const bool up = rises(in);
    T past(0.0);
    for (T start = level(up); is_beyond(in.end, start, up); start = level(up)) {
      if (is_beyond(in.begin, start, up)) {
        jump(in.begin, next);  // the command is already beyond the band at the beginning of the segment
        continue;
      }
      const T now = in.duration_s * in.fraction_at(start);
      stay(T(now - past), next);
      past = now;
      jump(start, next);
    }
    stay(T(in.duration_s - past), next);
  }

  T band_;
  bool moving_ = false;   // true: the valve follows a fast command
  bool upwards_ = false;  // true: the valve follows the fast command upwards; false: downwards
  T held_{0.0};
};

}  // namespace softgrip::model
