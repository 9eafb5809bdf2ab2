#pragma once
// Functions that blocks need for their number type: double, Dual, or an automatic differentiation type with
// the members `a` (value) and `v` (derivatives). Functions of <cmath> are found by argument-dependent lookup.

#include <type_traits>

namespace softgrip::model {

/// Returns the plain value, without derivatives. Decisions use this value.
template <class T>
[[nodiscard]] constexpr double value_of(const T& x) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.a;
  }
}

/// Returns true if value and all derivatives are equal. Such numbers are interchangeable in any formula.
template <class T>
[[nodiscard]] constexpr bool same(const T& x, const T& y) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x == y;
  } else {
    return x.a == y.a && x.v == y.v;
  }
}

/// Returns true if value and all derivatives are zero. A duration of 0 s can still depend on a fitted delay.
template <class T>
[[nodiscard]] constexpr bool is_zero(const T& x) noexcept {
  return same(x, T(0.0));
}

}  // namespace softgrip::model
