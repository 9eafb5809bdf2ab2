#pragma once
// Models a pressure regulator. The control error and its integral move a spool, which opens a port to the
// supply or to the atmosphere. While the spool is within its overlap, both ports are closed (Beater,
// Pneumatic Drives, 2007, chapters 5 and 8).

#include <algorithm>
#include <cmath>

#include "model/dual.h"
#include "model/exponential.h"
#include "model/port_flow.h"
#include "model/segment.h"

namespace softgrip::model {

/// Parameters of a regulator. A parameter with the value 0 has no effect. If both time constants are 0, the
/// pressure equals the command.
template <class T>
struct RegulatorNumbers {
  T filling_s{0.0};      ///< time constant while the port to the supply is open
  T venting_s{0.0};      ///< time constant while the port to the atmosphere is open, for a pressure of 50 kPa
                         ///< above atmospheric pressure
  T overlap_kpa{0.0};    ///< control error up to which both ports are closed
  T integral_s{0.0};     ///< integral time: a constant error doubles the spool position within this time
  T full_open_kpa{0.0};  ///< control error at which a port is fully open
};

/// The equations use e = u - p and v = e + integral of e / integral_s, limited to +-full_open_kpa. Here u is
/// the command and p the pressure:
///   filling_s p' = v - overlap if v > overlap;
///   venting_s p' / outflow(p) = v + overlap if v < -overlap;
///   otherwise p' = 0.
/// The integral stops if v is at its limit and would grow further. If only the time constants are above 0,
/// the regulator acts as a TwoWayLag whose venting time constant depends on outflow(p). A segment is divided
/// into steps. They are short while the pressure changes fast, and longer afterwards. In each step, the
/// integral is assumed to be linear in time, and outflow(p) is assumed to have its value at the middle of the
/// step. Apart from these two approximations, the solution is exact for straight input.
template <class T>
class RegulatedPressure {
 public:
  explicit RegulatedPressure(const RegulatorNumbers<T>& numbers) : n_(numbers) {}

  void reset(const T& input) {
    pressure_kpa_ = input;
    integral_kpa_ = T(0.0);
  }
  [[nodiscard]] const T& output() const { return pressure_kpa_; }
  /// Returns the contribution of the integral to the spool position v [kPa].
  [[nodiscard]] const T& integral_kpa() const { return integral_kpa_; }
  [[nodiscard]] const RegulatorNumbers<T>& numbers() const { return n_; }

  /// Returns the number of steps in which the last segment was computed; 0 if it needed no step.
  [[nodiscard]] int steps() const { return steps_; }

  /// Computes the pressure over a segment of the command. Passes on one segment for each part of the motion
  /// in which the pressure has one direction.
  template <class Next>
  void step(const Segment<T>& in, Next&& next) {
    steps_ = 0;
    if (value_of(n_.filling_s) <= 0 && value_of(n_.venting_s) <= 0) {
      pressure_kpa_ = in.end;
      next(in);
      return;
    }
    if (is_zero(in.duration_s)) return;  // a segment without duration does not change the pressure
    const double segment_s = value_of(in.duration_s), longest_s = longest_step_s(segment_s);
    const double range_kpa = std::max(std::abs(value_of(in.begin) - value_of(pressure_kpa_)),
                                      std::abs(value_of(in.end) - value_of(pressure_kpa_)));
    double lasts_s = first_step_s(segment_s), since_s = 0;
    Segment<T> out{T(0.0), pressure_kpa_, pressure_kpa_, pressure_kpa_};
    T area(0.0);
    while (since_s < segment_s) {
      const double until_s = segment_s - since_s < lasts_s * (1 + 1e-6) ? segment_s : since_s + lasts_s;
      const double begin = since_s / segment_s, end = until_s / segment_s;
      const T step_s = in.duration_s * (end - begin);
      const T from = in.at(T(begin)), to = in.at(T(end));
      const T before = pressure_kpa_;
      if (rests(from, to)) {
        // In the remaining steps of the segment, the regulator is at rest.
        const T rest_s = in.duration_s * (1 - begin);
        out.duration_s += rest_s;
        area += before * rest_s;
        break;
      }
      const T mean = go(step_s, from, to);
      const double way = value_of(pressure_kpa_) - value_of(before);
      if (way * (value_of(out.end) - value_of(out.begin)) < 0) {
        out.mean = area / out.duration_s;
        next(out);
        out = {T(0.0), before, before, before};
        area = T(0.0);
      }
      out.duration_s += step_s;
      out.end = pressure_kpa_;
      area += mean * step_s;
      since_s = until_s;
      if (++steps_ >= equal_steps && std::abs(way) < quiet_share * range_kpa)
        lasts_s = std::min(2 * lasts_s, longest_s);
    }
    out.mean = area / out.duration_s;
    next(out);
  }

 private:
  /// Gauge pressure for which venting_s is defined [kPa].
  static constexpr double usual_kpa = 50;
  static constexpr double shortest_s = 1e-4;
  /// With steps of 5 ms and 1/20 of a time constant, the error is at most 0.2 % of the largest jump of the
  /// command. The largest number of steps covers more than an hour.
  static constexpr double usual_step_s = 0.005, steps_per_constant = 20, most_steps = 1e6;
  /// Number of equal steps at the beginning of a segment. They cover one time constant.
  static constexpr int equal_steps = 20;
  /// Change of the pressure in a step below which the next step is twice as long, as a share of the largest
  /// difference between command and pressure. With this share, the longer steps do not increase the error
  /// above 0.2 % of the largest jump.
  static constexpr double quiet_share = 0.01;

  /// Returns the longest step for a segment of the duration `segment_s`. Longer steps than 1/20 of integral_s
  /// would make the integral unstable.
  [[nodiscard]] double longest_step_s(double segment_s) const {
    const double integral_s = value_of(n_.integral_s);
    const double stable_s = integral_s > 0 ? integral_s / steps_per_constant : segment_s;
    return std::max({stable_s, usual_step_s, segment_s / most_steps});
  }

  /// Returns the duration of the first steps: 1/20 of the shorter time constant, but not less than 5 ms. If
  /// the segment has only a few steps, they have equal durations.
  [[nodiscard]] double first_step_s(double segment_s) const {
    const double constant_s = std::min(value_of(n_.filling_s), value_of(n_.venting_s));
    const double step_s =
        std::clamp(constant_s / steps_per_constant, usual_step_s, longest_step_s(segment_s));
    const double count = std::max(std::ceil(segment_s / step_s - 1e-9), 1.0);
    return count <= equal_steps ? segment_s / count : step_s;
  }

  /// Returns the flow to the atmosphere at the gauge pressure `gauge_kpa`, divided by the sonic conductance
  /// of the port [kPa].
  static T outflow(const T& gauge_kpa) {
    if (value_of(gauge_kpa) <= 0) return T(0.0);
    return port_flow(T(gauge_kpa + atmosphere_kpa), T(atmosphere_kpa));
  }

  /// Returns true if the command is constant and equals the pressure, and the integral is within the overlap.
  [[nodiscard]] bool rests(const T& from, const T& to) const {
    constexpr double nothing_kpa = 1e-9;
    return value_of(from) == value_of(to) && std::abs(value_of(to) - value_of(pressure_kpa_)) < nothing_kpa &&
           std::abs(value_of(integral_kpa_)) <= value_of(n_.overlap_kpa);
  }

  /// Computes one step in which the input changes from `from` to `to`. Returns the mean of the pressure over
  /// the step.
  T go(const T& step_s, const T& from, const T& to) {
    if (!(value_of(n_.integral_s) > 0)) return follow(step_s, from, to);
    const T begins = from - pressure_kpa_;
    const double stopped_before = stops_by(begins);
    const T drift = stopped_before > 0 ? T(0.0) : T(begins * step_s / n_.integral_s);
    const T mean = follow(step_s, from + integral_kpa_, to + integral_kpa_ + drift);
    const T ends = to - pressure_kpa_;
    const double stopped_after = stops_by(ends);
    // Adds the mean error of the step to the integral. The error is computed from the new pressure. If the
    // limit of the spool stops the integral in a part of the step, only the error in the rest of the step is
    // added.
    if (stopped_before > 0 && stopped_after > 0) return mean;
    T error = (from + to) * 0.5 - mean;
    double share = 1;
    if (stopped_before > 0 || stopped_after > 0) {
      const double least = std::min(stopped_before, stopped_after);
      share = -least / (std::max(stopped_before, stopped_after) - least);
      const T& moving = stopped_before > 0 ? ends : begins;
      const T& other = stopped_before > 0 ? begins : ends;
      error = moving + (other - moving) * (0.5 * share);
    }
    integral_kpa_ += share * error * step_s / n_.integral_s;
    return mean;
  }

  /// Returns by how much the spool position v exceeds the limit at which the integral stops [kPa]. The
  /// integral changes only if the result is 0 or less.
  [[nodiscard]] double stops_by(const T& error) const {
    const double full = value_of(n_.full_open_kpa), asked = value_of(error) + value_of(integral_kpa_);
    if (!(full > 0)) return -1;
    return asked * value_of(error) > 0 ? std::abs(asked) - full : -1;
  }

  /// Advances the pressure by a step in which its target changes linearly from `wanted` to `wanted_after`.
  /// The overlap is a band around the target. A pressure outside this band moves towards the nearer edge of
  /// the band. Returns the mean of the pressure over the step.
  T follow(const T& step_s, const T& wanted, const T& wanted_after) {
    const double p = value_of(pressure_kpa_), band = value_of(n_.overlap_kpa);
    const bool fills = p < value_of(wanted) - band;
    if (!fills && !(p > value_of(wanted) + band)) return wait(step_s, wanted, wanted_after);
    const T aside = fills ? -n_.overlap_kpa : n_.overlap_kpa;
    const T edge = wanted + aside;
    T mean(0.0);
    const T lasts_s =
        towards(step_s, edge, wanted_after + aside, fills ? n_.filling_s : venting_s(edge, step_s), mean);
    const T rest_s = step_s - lasts_s;
    if (!(value_of(rest_s) > 1e-6 * value_of(step_s))) return mean;
    const T met = wanted + (wanted_after - wanted) * (lasts_s / step_s);
    return (mean * lasts_s + wait(rest_s, met, wanted_after) * rest_s) / step_s;
  }

  /// Advances a pressure that is within the band of the overlap. The pressure is constant until an edge of
  /// the band reaches the pressure. After that, the pressure moves towards this edge. Returns the mean of the
  /// pressure over the step.
  T wait(const T& step_s, const T& wanted, const T& wanted_after) {
    const double p = value_of(pressure_kpa_), band = value_of(n_.overlap_kpa);
    const bool fills = p < value_of(wanted_after) - band;
    if (!fills && !(p > value_of(wanted_after) + band)) return pressure_kpa_;
    const T aside = fills ? -n_.overlap_kpa : n_.overlap_kpa;
    const T edge = wanted + aside, edge_after = wanted_after + aside, before = pressure_kpa_;
    const T waits =
        value_of(edge_after) == value_of(edge) ? T(0.0) : T((before - edge) / (edge_after - edge));
    const T rest_s = step_s * (1.0 - waits);
    T mean(0.0);
    (void)towards(rest_s, before, edge_after, fills ? n_.filling_s : venting_s(edge_after, rest_s), mean);
    return before * waits + mean * (1.0 - waits);
  }

  /// Returns true if the ports have a largest opening.
  [[nodiscard]] bool is_limited() const { return value_of(n_.full_open_kpa) > 0; }
  /// Returns the difference between pressure and target, without the overlap, at which a port is fully open.
  [[nodiscard]] T widest_gap_kpa() const { return n_.full_open_kpa - n_.overlap_kpa; }

  /// Returns the time constant of venting at the middle of the step. The time constant is computed for the
  /// pressure that venting towards `target_kpa` has reached at this time.
  T venting_s(const T& target_kpa, const T& step_s) const {
    static const double usual = value_of(outflow(T(usual_kpa)));
    const T begins = outflow(pressure_kpa_);
    if (value_of(begins) <= 0) return T(1e9);  // a chamber at atmospheric pressure has no outflow
    const T z = step_s * begins / (n_.venting_s * usual), most = widest_gap_kpa();
    T gap = target_kpa - pressure_kpa_;
    if (is_limited() && value_of(gap) < -value_of(most)) gap = -most;
    const T halfway = outflow(pressure_kpa_ + gap * (z / (2.0 + z)));
    return n_.venting_s * (usual / (value_of(halfway) > 0 ? halfway : begins));
  }

  /// Moves the pressure as a first-order lag towards a target that changes linearly, until the pressure
  /// equals the target. Returns the duration of this motion, and sets `mean` to the mean pressure during the
  /// motion.
  T towards(const T& step_s, const T& target, const T& target_after, const T& time_constant, T& mean) {
    using std::log1p;
    const T tau = value_of(time_constant) > shortest_s ? time_constant : T(shortest_s);
    const T slope = (target_after - target) / step_s, most = widest_gap_kpa();
    T gap = target - pressure_kpa_, open_s(0.0), area(0.0);
    const double way = value_of(gap) != 0 ? value_of(gap) : value_of(slope);
    const double sign = way > 0 ? 1 : -1;
    const T rate = sign * most / tau;
    if (is_limited() && std::abs(value_of(gap)) > value_of(most)) {
      // The difference between target and pressure is so large that the port is fully open.
      open_s = step_s;
      if (sign * (value_of(rate) - value_of(slope)) > 0) {
        const T until_s = (gap - sign * most) / (rate - slope);
        if (value_of(until_s) < value_of(step_s)) open_s = until_s;
      }
      area = (pressure_kpa_ + rate * open_s * 0.5) * open_s;
      pressure_kpa_ += rate * open_s;
      gap += (slope - rate) * open_s;
    }
    T lags_s = step_s - open_s, open_at_end_s(0.0);
    const bool runs_away = sign * (value_of(slope) - value_of(rate)) > 0;
    if (is_limited() && runs_away && sign * value_of(gap) < value_of(most)) {
      // The target moves away so fast that the port becomes fully open. It stays so until the end of the
      // step.
      const T opens_s = tau * log1p((sign * most - gap) / (slope * tau - sign * most));
      if (value_of(opens_s) < value_of(lags_s)) {
        open_at_end_s = lags_s - opens_s;
        lags_s = opens_s;
      }
    }
    if (value_of(gap) * value_of(slope) < 0) {
      const T meets_s = tau * log1p(-gap / (slope * tau));
      if (value_of(meets_s) < value_of(lags_s)) lags_s = meets_s;
    }
    const T z = lags_s / tau;
    const PhiFunctions<T> f = phi_functions(z);
    const T rise = slope * lags_s, before = pressure_kpa_;
    pressure_kpa_ = before + z * f.phi1 * gap + z * f.phi2 * rise;
    area += (before + z * f.phi2 * gap + z * f.phi3 * rise) * lags_s;
    area += (pressure_kpa_ + rate * open_at_end_s * 0.5) * open_at_end_s;
    pressure_kpa_ += rate * open_at_end_s;
    const T lasts_s = open_s + lags_s + open_at_end_s;
    mean = value_of(lasts_s) > 0 ? T(area / lasts_s) : pressure_kpa_;
    return lasts_s;
  }

  RegulatorNumbers<T> n_;
  T pressure_kpa_{0.0}, integral_kpa_{0.0};
  int steps_ = 0;
};

}  // namespace softgrip::model
