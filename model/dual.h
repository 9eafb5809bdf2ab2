#pragma once
// Defines a number with one derivative (forward-mode automatic differentiation). The Newton steps of an
// implicit solution use such numbers.
// Defines the functions of the number type that the blocks need. The number type is double, Dual, or an
// automatic differentiation type with the members `a` (value) and `v` (derivatives). Functions of <cmath> are
// found by argument-dependent lookup.

#include <cmath>
#include <type_traits>

namespace softgrip::model {

/// A value `a` and its derivative `v` with respect to one variable. The derivative `v` of this variable
/// itself is 1.
template <class S>
struct Dual {
  S a{};
  S v{};

  constexpr Dual() = default;
  constexpr Dual(S value) : a(value) {}  // NOLINT(google-explicit-constructor): a constant is a number
  constexpr Dual(S value, S derivative) : a(value), v(derivative) {}

  constexpr Dual& operator+=(const Dual& y) { return *this = *this + y; }
  constexpr Dual& operator-=(const Dual& y) { return *this = *this - y; }
  constexpr Dual& operator*=(const Dual& y) { return *this = *this * y; }
  constexpr Dual& operator/=(const Dual& y) { return *this = *this / y; }

  friend constexpr Dual operator+(const Dual& x) { return x; }
  friend constexpr Dual operator-(const Dual& x) { return {-x.a, -x.v}; }
  friend constexpr Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, x.v + y.v}; }
  friend constexpr Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, x.v - y.v}; }
  friend constexpr Dual operator*(const Dual& x, const Dual& y) { return {x.a * y.a, x.v * y.a + x.a * y.v}; }
  friend constexpr Dual operator/(const Dual& x, const Dual& y) {
    const S quotient = x.a / y.a;
    return {quotient, (x.v - quotient * y.v) / y.a};
  }
  friend constexpr Dual operator*(const Dual& x, const S& y) { return {x.a * y, x.v * y}; }
  friend constexpr Dual operator*(const S& x, const Dual& y) { return {x * y.a, x * y.v}; }
  friend constexpr Dual operator+(const Dual& x, const S& y) { return {x.a + y, x.v}; }
  friend constexpr Dual operator+(const S& x, const Dual& y) { return {x + y.a, y.v}; }
  friend constexpr Dual operator-(const Dual& x, const S& y) { return {x.a - y, x.v}; }
  friend constexpr Dual operator-(const S& x, const Dual& y) { return {x - y.a, -y.v}; }
  friend constexpr Dual operator/(const Dual& x, const S& y) { return {x.a / y, x.v / y}; }

  // Comparisons use only the value `a` and ignore the derivative `v`.
  friend constexpr bool operator<(const Dual& x, const Dual& y) { return x.a < y.a; }
  friend constexpr bool operator>(const Dual& x, const Dual& y) { return x.a > y.a; }
  friend constexpr bool operator<=(const Dual& x, const Dual& y) { return x.a <= y.a; }
  friend constexpr bool operator>=(const Dual& x, const Dual& y) { return x.a >= y.a; }
  friend constexpr bool operator==(const Dual& x, const Dual& y) { return x.a == y.a; }
  friend constexpr bool operator!=(const Dual& x, const Dual& y) { return x.a != y.a; }

  friend Dual exp(const Dual& x) {
    const S e = std::exp(x.a);
    return {e, e * x.v};
  }
  friend Dual expm1(const Dual& x) {
    const S e = std::expm1(x.a);
    return {e, (e + S(1)) * x.v};
  }
  friend Dual log(const Dual& x) { return {std::log(x.a), x.v / x.a}; }
  friend Dual log1p(const Dual& x) { return {std::log1p(x.a), x.v / (S(1) + x.a)}; }
  friend Dual sqrt(const Dual& x) {
    const S root = std::sqrt(x.a);
    return {root, x.v / (S(2) * root)};
  }
  friend Dual sin(const Dual& x) { return {std::sin(x.a), std::cos(x.a) * x.v}; }
  friend Dual cos(const Dual& x) { return {std::cos(x.a), -std::sin(x.a) * x.v}; }
  friend Dual tanh(const Dual& x) {
    const S t = std::tanh(x.a);
    return {t, (S(1) - t * t) * x.v};
  }
  friend Dual abs(const Dual& x) { return x.a < S(0) ? -x : x; }
};

/// Returns the value of a number without its derivatives. Comparisons in the code use this value.
template <class T>
[[nodiscard]] constexpr double value_of(const T& x) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.a;
  }
}

/// Returns true if two numbers have equal values and equal derivatives. Two such numbers give the same result
/// in any formula.
template <class T>
[[nodiscard]] constexpr bool same(const T& x, const T& y) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x == y;
  } else {
    return x.a == y.a && x.v == y.v;
  }
}

/// Returns true if the value and all derivatives of a number are zero. The derivatives are checked, because a
/// duration of 0 s can have a derivative with respect to a fitted delay.
template <class T>
[[nodiscard]] constexpr bool is_zero(const T& x) noexcept {
  return same(x, T(0.0));
}

}  // namespace softgrip::model
