#pragma once
// A number with many derivatives carried along (forward mode), laid out for the processor's vector registers.
// Ceres' Jet does the same; its expressions are not inlined into the steps of a chain, where all time is
// spent.

#include <array>
#include <cmath>
#include <cstddef>

namespace softgrip::sysid {

/// Derivatives with respect to `count` (even) seeded parameters.
template <std::size_t count>
struct Derivatives {
  static_assert(count % 2 == 0);
  using Pair [[gnu::vector_size(16)]] = double;
  std::array<Pair, count / 2> pairs{};

  [[nodiscard]] double operator[](std::size_t i) const { return pairs[i / 2][i % 2]; }
  void set(std::size_t i, double value) { pairs[i / 2][i % 2] = value; }

  [[nodiscard]] friend bool operator==(const Derivatives& x, const Derivatives& y) {
    Pair difference{};
    for (std::size_t i = 0; i < count / 2; ++i) {
      const Pair d = x.pairs[i] - y.pairs[i];
      difference += d * d;
    }
    return difference[0] + difference[1] == 0.0;
  }
};

/// Value `a` and derivatives `v`. Comparisons look at the value alone, as decisions do.
template <std::size_t count>
struct Gradient {
  using V = Derivatives<count>;
  double a = 0;
  V v;

  Gradient() = default;
  Gradient(double value) : a(value) {}  // NOLINT(google-explicit-constructor): a constant is a number

  /// Value `value` and derivatives s x.v, s x.v + t y.v.
  [[gnu::always_inline]] static Gradient scaled(double value, double s, const Gradient& x) {
    Gradient r(value);
    for (std::size_t i = 0; i < count / 2; ++i) r.v.pairs[i] = x.v.pairs[i] * s;
    return r;
  }
  [[gnu::always_inline]] static Gradient combined(double value, double s, const Gradient& x, double t,
                                                  const Gradient& y) {
    Gradient r(value);
    for (std::size_t i = 0; i < count / 2; ++i) r.v.pairs[i] = x.v.pairs[i] * s + y.v.pairs[i] * t;
    return r;
  }

  [[gnu::always_inline]] Gradient& operator+=(const Gradient& y) {
    a += y.a;
    for (std::size_t i = 0; i < count / 2; ++i) v.pairs[i] += y.v.pairs[i];
    return *this;
  }
  [[gnu::always_inline]] Gradient& operator-=(const Gradient& y) {
    a -= y.a;
    for (std::size_t i = 0; i < count / 2; ++i) v.pairs[i] -= y.v.pairs[i];
    return *this;
  }
  [[gnu::always_inline]] Gradient& operator*=(const Gradient& y) { return *this = *this * y; }
  [[gnu::always_inline]] Gradient& operator/=(const Gradient& y) { return *this = *this / y; }

  [[gnu::always_inline]] friend Gradient operator+(const Gradient& x) { return x; }
  [[gnu::always_inline]] friend Gradient operator-(const Gradient& x) { return scaled(-x.a, -1.0, x); }
  [[gnu::always_inline]] friend Gradient operator+(Gradient x, const Gradient& y) { return x += y; }
  [[gnu::always_inline]] friend Gradient operator-(Gradient x, const Gradient& y) { return x -= y; }
  [[gnu::always_inline]] friend Gradient operator*(const Gradient& x, const Gradient& y) {
    return combined(x.a * y.a, y.a, x, x.a, y);
  }
  [[gnu::always_inline]] friend Gradient operator/(const Gradient& x, const Gradient& y) {
    const double inverse = 1.0 / y.a;
    const double quotient = x.a / y.a;
    return combined(quotient, inverse, x, -quotient * inverse, y);
  }
  [[gnu::always_inline]] friend Gradient operator+(Gradient x, double y) {
    x.a += y;
    return x;
  }
  [[gnu::always_inline]] friend Gradient operator+(double x, Gradient y) {
    y.a = x + y.a;
    return y;
  }
  [[gnu::always_inline]] friend Gradient operator-(Gradient x, double y) {
    x.a -= y;
    return x;
  }
  [[gnu::always_inline]] friend Gradient operator-(double x, const Gradient& y) {
    return scaled(x - y.a, -1.0, y);
  }
  [[gnu::always_inline]] friend Gradient operator*(const Gradient& x, double y) {
    return scaled(x.a * y, y, x);
  }
  [[gnu::always_inline]] friend Gradient operator*(double x, const Gradient& y) {
    return scaled(x * y.a, x, y);
  }
  [[gnu::always_inline]] friend Gradient operator/(const Gradient& x, double y) {
    return scaled(x.a / y, 1.0 / y, x);
  }
  [[gnu::always_inline]] friend Gradient operator/(double x, const Gradient& y) {
    const double quotient = x / y.a;
    return scaled(quotient, -quotient / y.a, y);
  }

  friend bool operator<(const Gradient& x, const Gradient& y) { return x.a < y.a; }
  friend bool operator>(const Gradient& x, const Gradient& y) { return x.a > y.a; }
  friend bool operator<=(const Gradient& x, const Gradient& y) { return x.a <= y.a; }
  friend bool operator>=(const Gradient& x, const Gradient& y) { return x.a >= y.a; }
  friend bool operator==(const Gradient& x, const Gradient& y) { return x.a == y.a; }

  friend Gradient exp(const Gradient& x) {
    const double e = std::exp(x.a);
    return scaled(e, e, x);
  }
  friend Gradient expm1(const Gradient& x) {
    const double e = std::expm1(x.a);
    return scaled(e, e + 1.0, x);
  }
  friend Gradient log(const Gradient& x) { return scaled(std::log(x.a), 1.0 / x.a, x); }
  friend Gradient log1p(const Gradient& x) { return scaled(std::log1p(x.a), 1.0 / (1.0 + x.a), x); }
  friend Gradient sqrt(const Gradient& x) {
    const double root = std::sqrt(x.a);
    return scaled(root, 0.5 / root, x);
  }
  friend Gradient sin(const Gradient& x) { return scaled(std::sin(x.a), std::cos(x.a), x); }
  friend Gradient cos(const Gradient& x) { return scaled(std::cos(x.a), -std::sin(x.a), x); }
  friend Gradient tanh(const Gradient& x) {
    const double t = std::tanh(x.a);
    return scaled(t, 1.0 - t * t, x);
  }
  friend Gradient abs(const Gradient& x) { return x.a < 0.0 ? -x : x; }
};

}  // namespace softgrip::sysid
