#pragma once
// Functions of the number type that the blocks need. The number type is double, Dual, or an automatic
// differentiation type with the members `a` (value) and `v` (derivatives). Functions of <cmath> are found by
// argument-dependent lookup.

#include <type_traits>

namespace softgrip::model {

/// Returns the value of a number without its derivatives. The code uses this value for decisions.
template <class T>
[[nodiscard]] constexpr double value_of(const T& x) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.a;
  }
}

/// Returns true if the value and all derivatives of the two numbers are equal. Such numbers give the same
/// result in any formula.
template <class T>
[[nodiscard]] constexpr bool same(const T& x, const T& y) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x == y;
  } else {
    return x.a == y.a && x.v == y.v;
  }
}

/// Returns true if the value and all derivatives are zero. A duration with the value 0 s can still have a
/// derivative with respect to a fitted delay.
template <class T>
[[nodiscard]] constexpr bool is_zero(const T& x) noexcept {
  return same(x, T(0.0));
}

}  // namespace softgrip::model
