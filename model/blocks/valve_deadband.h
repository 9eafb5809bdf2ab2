#pragma once
// The valve ignores changes smaller than a band: stiction of its spool, dead band of its regulator.

#include <cmath>

#include "model/block.h"
#include "model/play.h"

namespace softgrip::model {

/// form 0, play: after a reversal the pressure stays where it is until the command has come back by the band,
/// then it moves along.
///
/// form 1, stick and jump: the pressure stays until the command differs by more than the band, then jumps to
/// it and sticks anew; a ramp becomes a staircase. Stiction of positioners (stick band equal to slip jump:
/// Choudhury, Thornhill and Shah, Control Engineering Practice 13, 2005) and dead band of digital regulators.
/// All jumps of a segment are passed on at their times. A command that crosses a band in less than `rest_s`
/// is followed to where it stops: the spool does not come to rest in between.
template <class T>
class ValveDeadband {
 public:
  static constexpr BlockInfo info{.id = "valve_deadband",
                                  .station = Station::valve,
                                  .kind = Kind::pressure,
                                  .inverse = Inverse::ignored,
                                  .title = "Valve dead band",
                                  .meaning = "The valve ignores changes of the command smaller than a band.",
                                  .equation =
                                      "form 0: |u - p| <= band/2, p moves only when it must; form 1: "
                                      "p stays until |u - p| > band, then p = u"};
  static constexpr std::array parameters{
      ParameterSpec{.name = "band_kpa",
                    .unit = "kPa",
                    .default_value = 1.0,
                    .lower = 0.0,
                    .upper = 1000.0,
                    .scale = 0.5,
                    .meaning = "change (after a reversal in form 0) that is ignored",
                    .neutral = 0.0},
      ParameterSpec{.name = "form",
                    .unit = "",
                    .default_value = 0.0,
                    .lower = 0.0,
                    .upper = 1.0,
                    .scale = 1.0,
                    .meaning = "0: is dragged along, 1: sticks and jumps",
                    .whole = true,
                    .if_left_out = 0.0}};
  /// Within this time no spool moves and comes to rest again [s].
  static constexpr double rest_s = 2e-3;

  ValveDeadband(std::span<const T> values, const Preparation&)
      : band_(values[0]), jumps_(value_of(values[1]) > 0.5), play_(T(values[0] * 0.5)) {}

  void reset(const T& input) {
    play_.reset(input);
    moving_ = false;
    held_ = value_of(band_) > 0.0 ? T(std::trunc(value_of(input) / value_of(band_)) * band_) : input;
  }
  [[nodiscard]] T output() const { return jumps_ ? held_ : play_.output(); }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    if (!jumps_) {
      play_.step(in, next);
    } else if (is_followed(in)) {
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

  /// The command at which the spool breaks loose.
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

  // Faster than it can stick: once loose it goes along.
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

  // A staircase, one jump per band.
  template <class Next>
  void climb(const Segment<T>& in, Next& next) {
    moving_ = false;
    const bool up = rises(in);
    T past(0.0);
    for (T start = level(up); is_beyond(in.end, start, up); start = level(up)) {
      if (is_beyond(in.begin, start, up)) {
        jump(in.begin, next);  // from the beginning
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
  bool jumps_;
  bool moving_ = false;   // follows a fast command
  bool upwards_ = false;  // which way
  T held_{0.0};
  Play<T> play_;
};

}  // namespace softgrip::model
