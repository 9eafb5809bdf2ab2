#pragma once
// Defines the functions of the number type that the blocks need. The number type is double, Dual, or an
// automatic differentiation type with the members `a` (value) and `v` (derivatives). Functions of <cmath> are
// found by argument-dependent lookup.

#include <type_traits>

namespace softgrip::model {

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
