#pragma once
// What the blocks need of their number type: double, Dual, or an automatic differentiation type with the
// members `a` (value) and `v` (derivatives). Functions of <cmath> are found by argument-dependent lookup.

#include <type_traits>

namespace softgrip::model {

/// The plain value, without derivatives. Decisions are taken on it.
template <class T>
[[nodiscard]] constexpr double value_of(const T& x) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.a;
  }
}

/// Equal in value and in every derivative: interchangeable in any formula.
template <class T>
[[nodiscard]] constexpr bool same(const T& x, const T& y) noexcept {
  if constexpr (std::is_arithmetic_v<T>) {
    return x == y;
  } else {
    return x.a == y.a && x.v == y.v;
  }
}

/// Zero in value and in every derivative. A duration may be 0 s and still depend on a delay that is fitted.
template <class T>
[[nodiscard]] constexpr bool is_zero(const T& x) noexcept {
  return same(x, T(0.0));
}

}  // namespace softgrip::model
