#pragma once
// Models Bouc-Wen hysteresis as a function of the pressure (Zhang et al., Actuators 2025, 14(4), 193,
// equation 1, with the signs and absolute values of the standard form):
//   B(t) = alpha p - h,   h' = beta p' - gamma p' |h|^n - eta |p'| |h|^(n-1) h
// The model is rate independent: dh/dp = beta - (gamma + eta s) |h|^n with s = sgn(p' h).
// An AsymmetricBoucWen in the chain adds a term that differs between loading and unloading,
//   dh/dp = beta (1 + b sgn(p')) - (gamma + eta s + delta sgn(p') + epsilon sgn(p') s) |h|^n
// (The term in the sign of the velocity is that of the generalised Bouc-Wen models: Wang and Wen, Journal of
// Engineering Mechanics 126, 2000; Song and Der Kiureghian, Journal of Engineering Mechanics 132, 2006. With
// b and epsilon, loading and unloading have independent parameters.) A RateDependentWidth in the chain makes
// the loop wider at high pressure rates,
//   B = alpha p - h (1 + growth r/(r + rate)), settling r' = |p'| - r
// (Loop heights that grow with the rate: Ang, Khosla and Riviere, IEEE/ASME Transactions on Mechatronics 12,
// 2007. In this block, the growth saturates.) A RateDependentSaturation replaces eta by
// eta (1 + saturation r/(r + rate)), so that the hysteretic state saturates earlier at high rates.

#include <array>
#include <cmath>
#include <cstddef>

#include "model/block.h"
#include "model/exponential.h"

namespace softgrip::model {

/// Deviations of the parameters of bouc_wen for an asymmetric loop. Each deviation is added for loading and
/// subtracted for unloading. A deviation of 0 has no effect.
template <class T>
struct BoucWenSkew {
  T delta_per_kpa{0.0};    ///< deviation of the parameter gamma
  T epsilon_per_kpa{0.0};  ///< deviation of the parameter eta
  T beta_share{0.0};       ///< deviation of the parameter beta, as a share of beta
};

/// Parameters that determine how the hysteresis loop changes with the pressure rate.
template <class T>
struct BoucWenRate {
  T share{0.0};           ///< largest relative change of the loop width or of eta
  T half_kpa_per_s{1.0};  ///< pressure rate at which half of the largest change is reached
  T settling_s{1.0};      ///< time constant of the filter that averages the pressure rate
};

/// Computes the averaged pressure rate r, and the change of a parameter that depends on r. The equation of r
/// is settling r' = |p'| - r with the pressure p.
template <class T>
class AveragedRate {
 public:
  AveragedRate() = default;
  explicit AveragedRate(const BoucWenRate<T>& rate) : rate_(rate), settling_per_s_(1.0 / rate.settling_s) {}

  void reset() { kpa_per_s_ = T(0.0); }
  void step(const T& change_kpa, const T& duration_s) { kpa_per_s_ = after(change_kpa, duration_s); }

  /// Returns the averaged pressure rate r after `duration_s`. r relaxes towards the present rate |p'|. A jump
  /// of the pressure increases r by the size of the jump divided by settling_s.
  template <class U>
  [[nodiscard]] U after(const U& change_kpa, const T& duration_s) const {
    const T z = duration_s * settling_per_s_;
    const U size = value_of(change_kpa) < 0.0 ? U(-change_kpa) : change_kpa;
    return kpa_per_s_ + (size * settling_per_s_ - z * kpa_per_s_) * phi1(T(-z));
  }

  /// Returns the change of the parameter value `base` at a pressure rate. The change is 0 at rest. At rates
  /// far above half_kpa_per_s, the change approaches `base` times BoucWenRate::share.
  template <class U>
  [[nodiscard]] U share_of(const T& base, const U& kpa_per_s) const {
    return base * rate_.share * (kpa_per_s / (kpa_per_s + rate_.half_kpa_per_s));
  }
  [[nodiscard]] T share_of(const T& base) const { return share_of(base, kpa_per_s_); }

 private:
  BoucWenRate<T> rate_;
  T settling_per_s_{1.0};
  T kpa_per_s_{0.0};
};

/// Integrates the Bouc-Wen equation. For exponent 1, dh/dp is linear in h between two zeros of h. In this
/// case, the equation is integrated in closed form, which is exact for any step size. In a monotone step, h
/// changes its sign at most once. For other exponents, the classical Runge-Kutta method is used in sub-steps
/// of the pressure. The relative change of the slope in a sub-step is below 1/100 (local error about 1e-11 of
/// h). A sub-step ends where h is zero. The pressure at this point is an integral over h, which is computed
/// by Gauss-Legendre quadrature. The error of the mean of a segment is of the fourth order in the pressure
/// change of the segment (1e-7 mm at 0.5 kPa).
///
/// gamma and eta have the unit 1/(kPa mm^(exponent-1)). The names of the parameters contain the unit for
/// exponent 1, which is 1/kPa.
template <class T>
class BoucWen {
 public:
  static constexpr BlockInfo info =
      block_info("bouc_wen", Station::actuator, Kind::element, Inverse::implicit, "Bouc-Wen hysteresis",
                 "Rate-independent hysteresis of the Bouc-Wen model.",
                 "y += alpha p - h, h' = beta p' - gamma p' |h|^n - eta |p'| |h|^(n-1) h");
  static constexpr std::array parameters{
      parameter("alpha_mm_per_kpa", "mm/kPa",
                "elastic gain: displacement per pressure without the hysteretic state h", Typical{0.35},
                Within{0.0, 1e4}, Scale{0.1}, Neutral{0.0}, PerPressure{}),
      parameter("beta_mm_per_kpa", "mm/kPa",
                "initial gain of the hysteretic state h; the model has an inverse if this gain is below the "
                "instantaneous gain of the actuator",
                Typical{0.2}, Within{0.0, 1e4}, Scale{0.1}, Neutral{0.0}, PerPressure{}),
      parameter("gamma_per_kpa", "1/kPa",
                "saturation rate of the hysteretic state h, equal in both directions; for an exponent n, the "
                "unit is 1/(kPa mm^(n-1))",
                Typical{0.03}, Within{-1e4, 1e4}, Scale{0.02}, PerPressure{}),
      parameter("eta_per_kpa", "1/kPa",
                "saturation rate while the hysteretic state h grows, which determines the width of the loop; "
                "for an exponent n, the unit is 1/(kPa mm^(n-1))",
                Typical{0.03}, Within{0.0, 1e4}, Scale{0.02}, PerPressure{}),
      parameter("exponent", "", "exponent n, which determines the sharpness of the saturation", Typical{1.0},
                Within{1.0, 4.0}, Scale{1.0}, Whole{})};

  BoucWen(std::span<const T> values, const Preparation&)
      : alpha_(values[0]),
        beta_{values[1], values[1]},
        growing_{T(values[2] + values[3]), T(values[2] + values[3])},
        shrinking_{T(values[2] - values[3]), T(values[2] - values[3])},
        exponent_(static_cast<int>(std::lround(value_of(values[4])))) {}

  static std::string_view objection(std::span<const double> values) {
    return values[2] + values[3] < 0 ? "gamma_per_kpa + eta_per_kpa must be at least 0, because the "
                                       "hysteretic state would grow without bound with a negative sum"
                                     : std::string_view{};
  }

  /// Gives loading and unloading different parameters. The deviations in `skew` are added for loading and
  /// subtracted for unloading. `delta_per_kpa` is limited to +-eta and +-(gamma + eta). The saturation rates
  /// are limited to values that keep h bounded. Beyond these limits, h would grow while the pressure returns.
  /// Call skew() once for each AsymmetricBoucWen block.
  void skew(const BoucWenSkew<T>& skew) {
    const T eta = (growing_[0] - shrinking_[0]) * 0.5;
    const T most = value_of(eta) < value_of(growing_[0]) ? eta : growing_[0];
    T delta = skew.delta_per_kpa;
    if (value_of(delta) > value_of(most)) delta = most;
    if (value_of(delta) < -value_of(most)) delta = -most;
    growing_ = {growing_[0] - delta, growing_[1] + delta};
    shrinking_ = {shrinking_[0] - delta, shrinking_[1] + delta};
    if (is_zero(skew.epsilon_per_kpa) && is_zero(skew.beta_share)) return;
    beta_ = {beta_[0] * (1.0 - skew.beta_share), beta_[1] * (1.0 + skew.beta_share)};
    growing_ = {not_below(growing_[0] - skew.epsilon_per_kpa, 0.0),
                not_below(growing_[1] + skew.epsilon_per_kpa, 0.0)};
    shrinking_ = {shrinking_[0] + skew.epsilon_per_kpa, shrinking_[1] - skew.epsilon_per_kpa};
    // After h has saturated in one direction of the pressure, the magnitude of h must decrease when the
    // pressure reverses. At the exact bound, the saturated h would be an unstable equilibrium, from which a
    // rounding error would grow exponentially.
    constexpr double below_equilibrium = 1 - 1e-6;
    for (const std::size_t way : {0U, 1U}) {
      const T bound = below_equilibrium * (growing_[1 - way] * beta_[way] / beta_[1 - way]);
      if (value_of(shrinking_[way]) > value_of(bound)) shrinking_[way] = bound;
    }
  }

  /// Makes the loop wider as the pressure rate increases. At rates far above `rate.half_kpa_per_s`, the
  /// additional width approaches `rate.share` times the width. The result is exact at the end of a straight
  /// segment.
  void widen(const BoucWenRate<T>& rate) {
    follows_rate_ = true;
    widening_ = AveragedRate<T>(rate);
  }

  /// Increases the parameter eta with the pressure rate. At rates far above `rate.half_kpa_per_s`, the
  /// increase approaches `rate.share` times eta. During a segment, eta keeps the value that it has at the
  /// beginning of the segment.
  void saturate_earlier(const BoucWenRate<T>& rate) {
    follows_rate_ = true;
    saturation_ = AveragedRate<T>(rate);
    eta_ = (growing_[0] + growing_[1] - shrinking_[0] - shrinking_[1]) * 0.25;
    more_eta_ = T(0.0);
  }

  void reset(const T& input) {
    widening_.reset();
    saturation_.reset();
    more_eta_ = T(0.0);
    hysteresis_ = T(0.0);
    direction_ = value_of(input) < 0.0 ? -1.0 : 1.0;
    hysteresis_ = moved(input, direction_);
    pressure_ = input;
    output_ = alpha_ * pressure_ - hysteresis_;
  }

  [[nodiscard]] T output() const { return output_; }
  /// Returns the hysteretic state h [mm].
  [[nodiscard]] const T& hysteresis_mm() const { return hysteresis_; }
  /// Returns the slope dh/dp of the hysteretic state h over the pressure p, at the present state [mm/kPa]. If
  /// `rising` is true, returns the slope for a rising pressure, otherwise the slope for a falling pressure.
  [[nodiscard]] T slope(bool rising) const { return slope_at(hysteresis_, rising ? 1.0 : -1.0); }
  [[nodiscard]] const T& alpha_mm_per_kpa() const { return alpha_; }
  /// Returns the larger of the two values of beta for loading and for unloading.
  [[nodiscard]] const T& beta_mm_per_kpa() const {
    return value_of(beta_[0]) > value_of(beta_[1]) ? beta_[0] : beta_[1];
  }

  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    const T change = in.end - in.begin;
    const T begin = output_;
    if (is_zero(change) && !follows_rate_) return {in.duration_s, begin, begin, begin};
    const T before = hysteresis_;
    const double direction = direction_of(change);
    hysteresis_ = moved(change, direction);
    pressure_ = in.end;
    direction_ = direction;
    // Computes the mean of the hysteretic state h over the segment as the mean of a cubic. This cubic has the
    // values and slopes of h at the ends of the segment. A correction for the curvature of p over time is
    // added.
    const T slope_before = slope_at(before, direction);
    const T slope_after = slope_at(hysteresis_, direction);
    const T off_middle = in.mean - (in.begin + in.end) * 0.5;
    const T mean_h = (before + hysteresis_) * 0.5 + change * (slope_before - slope_after) * (1.0 / 12.0) +
                     (slope_before + slope_after) * 0.5 * off_middle;
    if (!follows_rate_) {
      output_ = alpha_ * pressure_ - hysteresis_;
      return {in.duration_s, begin, output_, alpha_ * in.mean - mean_h};
    }
    const T one(1.0);
    const T wide_before = 1.0 + widening_.share_of(one);
    widening_.step(change, in.duration_s);
    saturation_.step(change, in.duration_s);
    const T wide = 1.0 + widening_.share_of(one);
    more_eta_ = saturation_.share_of(eta_);
    output_ = alpha_ * pressure_ - hysteresis_ * wide;
    const T together = (hysteresis_ - before) * (wide - wide_before) * (1.0 / 12.0);
    return {in.duration_s, begin, output_,
            alpha_ * in.mean - mean_h * ((wide_before + wide) * 0.5) - together};
  }

  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, const Surroundings&) const {
    const U change = end_kpa - pressure_;
    const U h = moved(change, direction_of(change));
    if (!follows_rate_) return alpha_ * end_kpa - h;
    return alpha_ * end_kpa - h * (1.0 + widening_.share_of(T(1.0), widening_.after(change, duration_s)));
  }

 private:
  // Returns +1 if the pressure rises and -1 if the pressure falls. If the value of the change is zero,
  // returns the last direction, because a change with the value zero can have derivatives.
  template <class U>
  [[nodiscard]] double direction_of(const U& change) const {
    const double value = value_of(change);
    return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : direction_;
  }

  [[nodiscard]] const T& beta(double direction) const { return beta_[direction > 0.0 ? 1 : 0]; }

  static T not_below(const T& value, double bound) { return value_of(value) < bound ? T(bound) : value; }

  // Returns gamma + eta s + (delta + epsilon s) sgn(p') for the hysteretic state h and the direction
  // sgn(p') of the pressure change, where s = sgn(p' h). For h = 0, s is +1.
  [[nodiscard]] T rate(double h, double direction) const {
    const std::size_t way = direction > 0.0 ? 1 : 0;
    const bool grows = h * direction >= 0.0;
    if (!follows_rate_) return grows ? growing_[way] : shrinking_[way];
    return grows ? T(growing_[way] + more_eta_) : T(shrinking_[way] - more_eta_);
  }

  // Returns |h|^n, where h is the hysteretic state and n the exponent of the model.
  template <class U>
  [[nodiscard]] U power(const U& h) const {
    const U magnitude = value_of(h) < 0.0 ? U(-h) : h;
    switch (exponent_) {
      case 1:
        return magnitude;
      case 2:
        return magnitude * magnitude;
      case 3:
        return magnitude * magnitude * magnitude;
      default:
        return (magnitude * magnitude) * (magnitude * magnitude);
    }
  }

  [[nodiscard]] T slope_at(const T& h, double direction) const {
    return beta(direction) - rate(value_of(h), direction) * power(h);
  }

  // Returns the hysteretic state h after a monotone change of the pressure.
  template <class U>
  [[nodiscard]] U moved(const U& change, double direction) const {
    return exponent_ == 1 ? moved_linear(change, direction) : moved_in_steps(change, direction);
  }

  // Returns the hysteretic state h after a pressure change, for exponent 1. Solves dh/dp = beta - k h with k
  // = sgn(h) (gamma + eta s) and s = sgn(p' h). k has one constant value for h above 0, and another for h
  // below 0.
  template <class U>
  [[nodiscard]] U moved_linear(const U& change, double direction) const {
    const double h0 = value_of(hysteresis_);
    const T& gain = beta(direction);
    const T k = rate(h0, direction) * (h0 * direction >= 0.0 ? direction : -direction);
    const U end = hysteresis_ + change * (gain - k * hysteresis_) * phi1(U(-k * change));
    if (h0 * value_of(end) >= 0.0) return end;
    // h passes zero after a pressure change of -h0/beta * log(1 + x)/x, where x = -k h0 / beta and h0 is the
    // present h. After this change, the integration continues from h = 0.
    using std::log1p;
    const T x = -k * hysteresis_ / gain;
    const T stretch = std::abs(value_of(x)) < 1e-5 ? T(1.0 - x * 0.5 + x * x * (1.0 / 3.0)) : T(log1p(x) / x);
    const U rest = change + hysteresis_ / gain * stretch;
    return rest * gain * phi1(U(-(rate(0.0, direction) * direction) * rest));
  }

  template <class U>
  [[nodiscard]] U moved_in_steps(const U& change, double direction) const {
    const int steps = steps_for(std::abs(value_of(change)), direction);
    const U piece = change * (1.0 / steps);
    U h = U(hysteresis_);
    const T& gain = beta(direction);
    for (int i = 0; i < steps; ++i) {
      const T k = rate(value_of(h), direction);
      U next = runge_kutta(h, piece, gain, k);
      if (value_of(h) * value_of(next) < 0.0) {
        next = runge_kutta(U(0.0), U(piece - to_zero(h, gain, k) * direction), gain, rate(0.0, direction));
      }
      h = next;
    }
    return h;
  }

  // Returns the number of sub-steps for a pressure change, at most 100000. In each sub-step, the relative
  // change n k |h|^(n-1) dp of the slope dh/dp is at most 1/100, where k is the larger of rate() for growing
  // |h| and the magnitude of rate() for shrinking |h|. If h saturates, h also changes by at most 1/40 of its
  // saturation value. With 100000 sub-steps, these changes may be larger.
  [[nodiscard]] int steps_for(double change_kpa, double direction) const {
    constexpr int most = 100000;
    const double beta = value_of(this->beta(direction));
    const double growing = value_of(rate(direction, direction));
    const double shrinking = value_of(rate(-direction, direction));
    double largest = std::abs(value_of(hysteresis_)) + beta * change_kpa;
    double wanted = 1.0;
    if (growing > 0.0) {
      const double level = std::pow(beta / growing, 1.0 / exponent_);
      largest = std::fmin(largest, std::fmax(std::abs(value_of(hysteresis_)), level));
      wanted = 40.0 * beta * change_kpa / level;
    }
    const double k = std::fmax(growing, std::abs(shrinking));
    wanted =
        std::ceil(std::fmax(wanted, 100.0 * exponent_ * k * std::pow(largest, exponent_ - 1) * change_kpa));
    return wanted > most ? most : wanted < 1.0 ? 1 : static_cast<int>(wanted);
  }

  template <class U>
  [[nodiscard]] U runge_kutta(const U& h, const U& change, const T& gain, const T& k) const {
    const U s1 = gain - k * power(h);
    const U s2 = gain - k * power(U(h + change * s1 * 0.5));
    const U s3 = gain - k * power(U(h + change * s2 * 0.5));
    const U s4 = gain - k * power(U(h + change * s3));
    return h + change * (s1 + 2.0 * s2 + 2.0 * s3 + s4) * (1.0 / 6.0);
  }

  // Returns the pressure change that reduces the hysteretic state h to zero, for the equation dh/dp = beta -
  // k |h|^n. The result is the integral of dv / (beta - k v^n) over v from 0 to |h|, by Gauss-Legendre
  // quadrature with five points.
  template <class U>
  [[nodiscard]] U to_zero(const U& h, const T& gain, const T& k) const {
    constexpr std::array<double, 5> nodes{0.04691007703066800, 0.2307653449471585, 0.5, 0.7692346550528415,
                                          0.9530899229693320};
    constexpr std::array<double, 5> weights{0.1184634425280945, 0.2393143352496832, 0.2844444444444444,
                                            0.2393143352496832, 0.1184634425280945};
    const U magnitude = value_of(h) < 0.0 ? U(-h) : h;
    U sum = U(0.0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      sum = sum + weights[i] / (gain - k * power(U(magnitude * nodes[i])));
    }
    return magnitude * sum;
  }

  T alpha_;
  std::array<T, 2> beta_;       // beta for falling and for rising pressure
  std::array<T, 2> growing_;    // gamma + eta, for falling and for rising pressure
  std::array<T, 2> shrinking_;  // gamma - eta, for falling and for rising pressure
  int exponent_;
  double direction_ = 1.0;
  bool follows_rate_ = false;
  AveragedRate<T> widening_;    // averaged pressure rate that determines the width of the loop
  AveragedRate<T> saturation_;  // averaged pressure rate that determines eta
  T eta_{0.0};
  T more_eta_{0.0};
  T hysteresis_{0.0};
  T pressure_{0.0};
  T output_{0.0};
};

/// Base class of the blocks that modify the chain's Bouc-Wen element. Each of these blocks declares `void
/// shape(BoucWen<T>&) const`. The chain calls this function once after all blocks are constructed. These
/// blocks add no displacement of their own. If the chain has no bouc_wen, these blocks have no effect.
template <class T>
class BoucWenPart {
 public:
  void reset(const T&) {}
  [[nodiscard]] T output() const { return T(0.0); }
  Segment<T> step(const Segment<T>& in, const Surroundings&) {
    return {in.duration_s, T(0.0), T(0.0), T(0.0)};
  }
  template <class U>
  [[nodiscard]] U peek(const T&, const U&, const Surroundings&) const {
    return U(0.0);
  }
};

}  // namespace softgrip::model
