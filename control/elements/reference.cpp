#include "control/elements/reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace softgrip::control {
namespace {

/// Peak speed of a minimum-jerk motion over a distance of 1 in a time of 1 (Flash and Hogan, J. Neurosci. 5,
/// 1985).
constexpr double peak_speed_factor = 1.875;
/// Time in which a reference brakes to rest if it was cut while it moved [s]. The next ramp begins after this
/// time.
constexpr double brake_s = 0.2;

/// Returns the polynomial of degree 5 that goes from the moving start `from` to rest at `value` within
/// `duration`. The result contains the coefficients of the powers of time.
std::array<double, 6> quintic_to_rest(const ReferencePoint& from, double value, double duration) {
  const double t = duration;
  const double distance = value - from.value;
  const double v = from.rate * t;
  const double a = from.acceleration * t * t;
  const double t2 = t * t;
  return {from.value,
          from.rate,
          from.acceleration / 2,
          (10 * distance - 6 * v - 1.5 * a) / (t2 * t),
          (-15 * distance + 8 * v + 1.5 * a) / (t2 * t2),
          (6 * distance - 3 * v - 0.5 * a) / (t2 * t2 * t)};
}

}  // namespace

void Reference::start(double time_s, double value) noexcept {
  start(time_s, ReferencePoint{.value = value});
}

void Reference::start(double time_s, const ReferencePoint& point) noexcept {
  count_ = 0;
  rest_from_s_ = time_s;
  rest_ = point;
}

double Reference::value_of(const Segment& segment, double time_s) noexcept {
  const double t = time_s - segment.start_s;
  const auto& c = segment.c;
  switch (segment.shape) {
    case Shape::quintic:
      return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
    case Shape::sine:
      return c[0] - c[1] * std::cos(c[2] * t);
  }
  return 0;
}

ReferencePoint Reference::evaluate(const Segment& segment, double time_s) noexcept {
  const double t = time_s - segment.start_s;
  const auto& c = segment.c;
  const double value = value_of(segment, time_s);
  switch (segment.shape) {
    case Shape::quintic:
      return {.value = value,
              .rate = c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5]))),
              .acceleration = 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5]))};
    case Shape::sine: {
      const double phase = c[2] * t;
      return {.value = value,
              .rate = c[1] * c[2] * std::sin(phase),
              .acceleration = c[1] * c[2] * c[2] * std::cos(phase)};
    }
  }
  return {};
}

ReferencePoint Reference::last_point() const noexcept {
  if (count_ == 0) return rest_;
  const Segment& last = segments_[count_ - 1];
  return evaluate(last, last.start_s + last.duration_s);
}

Reference::Place Reference::place(double time_s) const noexcept {
  for (std::size_t i = count_; i-- > 0;) {
    const Segment& segment = segments_[i];
    if (time_s < segment.start_s) continue;
    const double end_s = segment.start_s + segment.duration_s;
    return time_s <= end_s ? Place{.segment = &segment, .time_s = time_s, .moves = true}
                           : Place{.segment = &segment, .time_s = end_s, .moves = false};
  }
  return count_ == 0 ? Place{}
                     : Place{.segment = &segments_[0], .time_s = segments_[0].start_s, .moves = false};
}

double Reference::value_of(const Place& there) const noexcept {
  return there.segment == nullptr ? rest_.value : value_of(*there.segment, there.time_s);
}

ReferencePoint Reference::at(double time_s) const noexcept {
  const Place there = place(time_s);
  return there.moves ? evaluate(*there.segment, there.time_s) : ReferencePoint{.value = value_of(there)};
}

double Reference::value_at(double time_s) const noexcept {
  return value_of(place(time_s));
}

double Reference::end_s() const noexcept {
  return count_ == 0 ? rest_from_s_ : segments_[count_ - 1].start_s + segments_[count_ - 1].duration_s;
}

double Reference::final_value() const noexcept {
  return last_point().value;
}

bool Reference::append(Shape shape, double duration_s, const std::array<double, 6>& c) noexcept {
  const double start_s = end_s();
  if (count_ == capacity || !(duration_s >= 0) || !std::isfinite(start_s + duration_s)) return false;
  if (!std::all_of(c.begin(), c.end(), [](double one) { return std::isfinite(one); })) return false;
  segments_[count_++] = {.shape = shape, .start_s = start_s, .duration_s = duration_s, .c = c};
  return true;
}

bool Reference::ramp_for(double value, double duration_s) noexcept {
  if (!(duration_s > 0)) return false;
  return append(Shape::quintic, duration_s, quintic_to_rest(last_point(), value, duration_s));
}

bool Reference::ramp_to(double value, double speed) noexcept {
  if (!(speed > 0)) return false;
  const ReferencePoint from = last_point();
  const bool moving = from.rate != 0 || from.acceleration != 0;
  if (count_ + (moving ? 2U : 1U) > capacity) return false;
  // Appends a ramp that brakes the reference to speed 0 without a reversal. The ramp covers half of the
  // distance that the present speed would cover in brake_s.
  const std::size_t count_before = count_;
  if (moving && !ramp_for(from.value + from.rate * brake_s / 2, brake_s)) return false;
  const double distance = std::abs(value - final_value());
  if (distance == 0) return moving || hold_for(0);
  if (ramp_for(value, peak_speed_factor * distance / speed)) return true;
  count_ = count_before;
  return false;
}

bool Reference::hold_for(double duration_s) noexcept {
  return append(Shape::quintic, duration_s, {final_value(), 0, 0, 0, 0, 0});
}

bool Reference::sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept {
  if (!(frequency_hz > 0) || !(cycles > 0)) return false;
  if (!std::isfinite(std::abs(mean) + std::abs(amplitude))) return false;
  return append(Shape::sine, cycles / frequency_hz,
                {mean, amplitude, 2 * std::numbers::pi * frequency_hz, 0, 0, 0});
}

void Reference::cut(double time_s) noexcept {
  while (count_ > 0 && segments_[count_ - 1].start_s >= time_s) {
    rest_ = {.value = evaluate(segments_[count_ - 1], segments_[count_ - 1].start_s).value};
    --count_;
  }
  if (count_ == 0) {
    rest_from_s_ = time_s;
    return;
  }
  Segment& last = segments_[count_ - 1];
  if (end_s() >= time_s) {
    last.duration_s = time_s - last.start_s;
  } else if (!hold_for(time_s - end_s())) {
    start(time_s, final_value());
  }
}

void Reference::forget_before(double time_s) noexcept {
  std::size_t gone = 0;
  while (gone < count_ && segments_[gone].start_s + segments_[gone].duration_s < time_s) ++gone;
  if (gone == 0) return;
  if (gone == count_) {
    start(end_s(), final_value());
    return;
  }
  for (std::size_t i = gone; i < count_; ++i) segments_[i - gone] = segments_[i];
  count_ -= gone;
}

}  // namespace softgrip::control
