#pragma once
// Computes the response of a second-order linear system over one segment. The response is exact if the input
// is a parabola in time.

#include <array>
#include <cmath>
#include <cstddef>

#include "model/dual.h"
#include "model/segment.h"
#include "model/weight_cache.h"

namespace softgrip::model {

/// Solves z'' + 2 d w z' + w^2 z = w^2 y, where y is the input, z the output, w the angular frequency [rad/s]
/// and d > 0 the damping ratio. A system with d < 1 oscillates. A system with d >= 1 has two real poles.
template <class T>
class SecondOrder {
 public:
  SecondOrder(const T& omega, const T& damping) : omega_(omega), damping_(damping) {}

  /// Sets the state of rest for a constant input.
  void reset(const T& input) {
    value_ = input;
    rate_ = T(0.0);
  }
  [[nodiscard]] const T& omega() const { return omega_; }
  /// Returns z.
  [[nodiscard]] const T& value() const { return value_; }
  /// Returns z' [1/s].
  [[nodiscard]] const T& rate() const { return rate_; }

  /// Advances by a segment with a duration above 0. Returns the mean of z over the segment. The mean follows
  /// from the integral of the differential equation over the segment.
  T advance(const Segment<T>& in) {
    if (is_short(value_of(in.duration_s))) return advance_by_series(in);
    const T begin = value_;
    const T rate = rate_;
    move(in);
    const T left = (rate_ - rate) + 2.0 * damping_ * omega_ * (value_ - begin);
    return in.mean - left / (omega_ * omega_ * in.duration_s);
  }

 private:
  /// Returns true if a segment is much shorter than the time constants of the system. The closed form divides
  /// by (w dt)^2 and loses its digits in such a segment.
  [[nodiscard]] bool is_short(double dt) const {
    const double angle = value_of(omega_) * dt;
    const double damping = value_of(damping_);
    return damping < 1.0 ? angle < 1e-3 : 2.0 * damping * angle < 1.0;
  }

  /// Advances by a power series in t / dt. The coefficients follow from the differential equation. In a short
  /// segment, at most 22 terms are needed for the full accuracy of a double. The series ends when two
  /// consecutive terms no longer change the sums.
  T advance_by_series(const Segment<T>& in) {
    const T bend = in.bend();
    const T angle = omega_ * in.duration_s;
    const std::array<T, 3> input{in.begin, in.end - in.begin + bend, -bend};
    T now = value_;
    T next = rate_ * in.duration_s;
    T value = now + next;
    T rate = next;
    T mean = now + next * 0.5;
    bool was_settled = false;
    for (std::size_t n = 0; n < 20; ++n) {
      const T value_before = value, rate_before = rate, mean_before = mean;
      const auto order = static_cast<double>(n);
      T drive = -now;
      if (n < input.size()) drive += input[n];
      const T after = angle * (angle * drive - 2.0 * damping_ * (order + 1.0) * next) *
                      (1.0 / ((order + 1.0) * (order + 2.0)));
      now = next;
      next = after;
      value += next;
      rate += next * (order + 2.0);
      mean += next * (1.0 / (order + 3.0));
      const bool is_settled = n >= input.size() && same(value, value_before) && same(rate, rate_before) &&
                              same(mean, mean_before);
      if (is_settled && was_settled) break;
      was_settled = is_settled;
    }
    value_ = value;
    rate_ = rate / in.duration_s;
    return mean;
  }

  /// Parts of the homogeneous solution after a time t, with the poles -decay +- r: exp(-decay t) cosh(r t)
  /// and exp(-decay t) sinh(r t) / r. For an oscillating system, r is imaginary.
  struct Decay {
    T cosine, sine;
  };
  /// Distance of d^2 from 1 below which the two poles are treated as one double pole.
  static constexpr double double_pole = 1e-6;

  [[nodiscard]] const Decay& decay_after(const T& dt) {
    const auto [slot, is_new] = durations_.at(dt);
    if (is_new) decays_[slot] = new_decay(dt);
    return decays_[slot];
  }

  [[nodiscard]] Decay new_decay(const T& dt) const {
    using std::cos;
    using std::exp;
    using std::expm1;
    using std::sin;
    using std::sqrt;
    const T distance = 1.0 - damping_ * damping_;
    const T decay = damping_ * omega_;
    if (std::abs(value_of(distance)) < double_pole) {
      const T envelope = exp(-decay * dt);
      const T square = omega_ * omega_ * distance * dt * dt;
      return {envelope * (1.0 - square * 0.5), envelope * dt * (1.0 - square * (1.0 / 6.0))};
    }
    if (value_of(distance) < 0.0) {
      const T root = sqrt(damping_ * damping_ - 1.0);
      const T r = omega_ * root;
      const T slow = exp(-omega_ * dt / (damping_ + root));
      const T gone = -expm1(-2.0 * r * dt);
      return {slow * (1.0 - 0.5 * gone), slow * gone / (2.0 * r)};
    }
    const T ringing = omega_ * sqrt(distance);
    const T envelope = exp(-decay * dt);
    return {envelope * cos(ringing * dt), envelope * sin(ringing * dt) / ringing};
  }

  // Computes the solution as the sum of a parabola a + b t + c t^2 (particular solution) and a decaying
  // homogeneous solution.
  void move(const Segment<T>& in) {
    const T& dt = in.duration_s;
    const T bend = in.bend();
    const T c = -bend / (dt * dt);
    const T b = (in.end - in.begin + bend) / dt - 4.0 * damping_ * c / omega_;
    const T a = in.begin - 2.0 * damping_ * b / omega_ - 2.0 * c / (omega_ * omega_);
    const T decay = damping_ * omega_;
    const auto& [cosine, sine] = decay_after(dt);
    const T offset = value_ - a;
    const T rate = rate_ - b;
    value_ = a + b * dt + c * dt * dt + (cosine + decay * sine) * offset + sine * rate;
    rate_ = b + 2.0 * c * dt - omega_ * omega_ * sine * offset + (cosine - decay * sine) * rate;
  }

  T omega_;
  T damping_;
  T value_{0.0};
  T rate_{0.0};
  RecentDurations<T> durations_;
  std::array<Decay, RecentDurations<T>::slots> decays_{};
};

}  // namespace softgrip::model
