#pragma once
// A number with many derivatives (forward-mode automatic differentiation), stored for vector registers. The
// Jet type of Ceres is equivalent. However, the compiler does not inline the expressions of Jet into the
// steps of a chain, and these steps need most of the computing time.
//
// An operator returns an expression. The value of an expression is computed immediately. Its derivatives are
// computed in pairs when a Gradient is constructed from the expression, so that a formula needs one loop over
// the derivatives instead of one loop per operator. An expression refers to the Gradients that it contains.
// Convert an expression to a Gradient while these Gradients exist, and never store an expression in an `auto`
// variable.

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace softgrip::sysid {

/// Two derivatives in one vector register.
using DerivativePair [[gnu::vector_size(16)]] = double;

/// Derivatives with respect to `count` parameters. `count` is even.
template <std::size_t count>
struct Derivatives {
  static_assert(count % 2 == 0);
  std::array<DerivativePair, count / 2> pairs;

  [[nodiscard]] double operator[](std::size_t i) const { return pairs[i / 2][i % 2]; }
  void set(std::size_t i, double value) { pairs[i / 2][i % 2] = value; }

  [[nodiscard]] friend bool operator==(const Derivatives& x, const Derivatives& y) {
    DerivativePair difference{};
    for (std::size_t i = 0; i < count / 2; ++i) {
      const DerivativePair d = x.pairs[i] - y.pairs[i];
      difference += d * d;
    }
    return difference[0] + difference[1] == 0.0;
  }
};

/// A Gradient or an expression. It has a value `a`, and pair(i) returns the derivatives 2i and 2i + 1.
template <class E>
concept GradientLike = requires(const E& e, std::size_t i) {
  { e.a } -> std::convertible_to<double>;
  { E::derivatives } -> std::convertible_to<std::size_t>;
  { e.pair(i) } -> std::same_as<DerivativePair>;
};

/// Value `a` and derivatives `v`. Comparisons use only the value.
template <std::size_t count>
struct Gradient {
  static constexpr std::size_t derivatives = count;
  double a;
  Derivatives<count> v;

  Gradient() : Gradient(0.0) {}
  Gradient(double value) : a(value), v{} {}  // NOLINT(google-explicit-constructor): a constant is a number
  template <GradientLike E>
  [[gnu::always_inline]] Gradient(const E& e) : a(e.a) {  // NOLINT(google-explicit-constructor): its value
    for (std::size_t i = 0; i < count / 2; ++i) v.pairs[i] = e.pair(i);
  }
  /// Assigns an expression, which may contain *this, because pair i of an expression depends only on the
  /// pairs i of its operands.
  template <GradientLike E>
  [[gnu::always_inline]] Gradient& operator=(const E& e) {
    for (std::size_t i = 0; i < count / 2; ++i) v.pairs[i] = e.pair(i);
    a = e.a;
    return *this;
  }
  [[nodiscard, gnu::always_inline]] DerivativePair pair(std::size_t i) const { return v.pairs[i]; }

  template <GradientLike E>
  [[gnu::always_inline]] Gradient& operator+=(const E& e) {
    for (std::size_t i = 0; i < count / 2; ++i) v.pairs[i] += e.pair(i);
    a += e.a;
    return *this;
  }
  template <GradientLike E>
  [[gnu::always_inline]] Gradient& operator-=(const E& e) {
    for (std::size_t i = 0; i < count / 2; ++i) v.pairs[i] -= e.pair(i);
    a -= e.a;
    return *this;
  }
  template <class Y>
  [[gnu::always_inline]] Gradient& operator*=(const Y& y) {
    return *this = *this * y;
  }
  template <class Y>
  [[gnu::always_inline]] Gradient& operator/=(const Y& y) {
    return *this = *this / y;
  }
};

/// The type of an operand in an expression: a reference for a Gradient, a copy for another expression.
template <class E>
struct HeldInExpression {
  using Type = const E;
};
template <std::size_t count>
struct HeldInExpression<Gradient<count>> {
  using Type = const Gradient<count>&;
};
template <class E>
using Held = typename HeldInExpression<E>::Type;

/// An expression with value `a` and derivatives s x', where x' are the derivatives of x.
template <class X>
struct ScaledGradient {
  static constexpr std::size_t derivatives = X::derivatives;
  double a;
  double s;
  Held<X> x;
  [[nodiscard, gnu::always_inline]] DerivativePair pair(std::size_t i) const { return x.pair(i) * s; }
};
/// An expression with value `a` and derivatives s x' + t y', where x' and y' are the derivatives of x and y.
template <class X, class Y>
struct CombinedGradient {
  static_assert(X::derivatives == Y::derivatives);
  static constexpr std::size_t derivatives = X::derivatives;
  double a;
  double s;
  Held<X> x;
  double t;
  Held<Y> y;
  [[nodiscard, gnu::always_inline]] DerivativePair pair(std::size_t i) const {
    return x.pair(i) * s + y.pair(i) * t;
  }
};
/// The expression x + y or x - y, depending on `sign`. A sum and a difference have the same type, so that a
/// conditional expression can contain both.
template <class X, class Y>
struct AddedGradient {
  static_assert(X::derivatives == Y::derivatives);
  static constexpr std::size_t derivatives = X::derivatives;
  double a;
  Held<X> x;
  double sign;
  Held<Y> y;
  [[nodiscard, gnu::always_inline]] DerivativePair pair(std::size_t i) const {
    return x.pair(i) + y.pair(i) * sign;
  }
};
/// An expression with value `a` and the derivatives of x.
template <class X>
struct MovedGradient {
  static constexpr std::size_t derivatives = X::derivatives;
  double a;
  Held<X> x;
  [[nodiscard, gnu::always_inline]] DerivativePair pair(std::size_t i) const { return x.pair(i); }
};

#define SOFTGRIP_OPERATOR [[nodiscard, gnu::always_inline]] inline auto
template <GradientLike X>
SOFTGRIP_OPERATOR operator+(const X& x) {
  return MovedGradient<X>{x.a, x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR operator-(const X& x) {
  return ScaledGradient<X>{-x.a, -1.0, x};
}
template <GradientLike X, GradientLike Y>
SOFTGRIP_OPERATOR operator+(const X& x, const Y& y) {
  return AddedGradient<X, Y>{x.a + y.a, x, 1.0, y};
}
template <GradientLike X, GradientLike Y>
SOFTGRIP_OPERATOR operator-(const X& x, const Y& y) {
  return AddedGradient<X, Y>{x.a - y.a, x, -1.0, y};
}
template <GradientLike X, GradientLike Y>
SOFTGRIP_OPERATOR operator*(const X& x, const Y& y) {
  return CombinedGradient<X, Y>{x.a * y.a, y.a, x, x.a, y};
}
template <GradientLike X, GradientLike Y>
SOFTGRIP_OPERATOR operator/(const X& x, const Y& y) {
  const double inverse = 1.0 / y.a;
  const double quotient = x.a / y.a;
  return CombinedGradient<X, Y>{quotient, inverse, x, -quotient * inverse, y};
}
template <GradientLike X>
SOFTGRIP_OPERATOR operator+(const X& x, double y) {
  return MovedGradient<X>{x.a + y, x};
}
template <GradientLike Y>
SOFTGRIP_OPERATOR operator+(double x, const Y& y) {
  return MovedGradient<Y>{x + y.a, y};
}
template <GradientLike X>
SOFTGRIP_OPERATOR operator-(const X& x, double y) {
  return MovedGradient<X>{x.a - y, x};
}
template <GradientLike Y>
SOFTGRIP_OPERATOR operator-(double x, const Y& y) {
  return ScaledGradient<Y>{x - y.a, -1.0, y};
}
template <GradientLike X>
SOFTGRIP_OPERATOR operator*(const X& x, double y) {
  return ScaledGradient<X>{x.a * y, y, x};
}
template <GradientLike Y>
SOFTGRIP_OPERATOR operator*(double x, const Y& y) {
  return ScaledGradient<Y>{x * y.a, x, y};
}
template <GradientLike X>
SOFTGRIP_OPERATOR operator/(const X& x, double y) {
  return ScaledGradient<X>{x.a / y, 1.0 / y, x};
}
template <GradientLike Y>
SOFTGRIP_OPERATOR operator/(double x, const Y& y) {
  const double quotient = x / y.a;
  return ScaledGradient<Y>{quotient, -quotient / y.a, y};
}

template <GradientLike X>
SOFTGRIP_OPERATOR exp(const X& x) {
  const double e = std::exp(x.a);
  return ScaledGradient<X>{e, e, x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR expm1(const X& x) {
  const double e = std::expm1(x.a);
  return ScaledGradient<X>{e, e + 1.0, x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR log(const X& x) {
  return ScaledGradient<X>{std::log(x.a), 1.0 / x.a, x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR log1p(const X& x) {
  return ScaledGradient<X>{std::log1p(x.a), 1.0 / (1.0 + x.a), x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR sqrt(const X& x) {
  const double root = std::sqrt(x.a);
  return ScaledGradient<X>{root, 0.5 / root, x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR sin(const X& x) {
  return ScaledGradient<X>{std::sin(x.a), std::cos(x.a), x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR cos(const X& x) {
  return ScaledGradient<X>{std::cos(x.a), -std::sin(x.a), x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR tanh(const X& x) {
  const double t = std::tanh(x.a);
  return ScaledGradient<X>{t, 1.0 - t * t, x};
}
template <GradientLike X>
SOFTGRIP_OPERATOR abs(const X& x) {
  const double sign = x.a < 0.0 ? -1.0 : 1.0;
  return ScaledGradient<X>{sign * x.a, sign, x};
}
#undef SOFTGRIP_OPERATOR

/// Returns the value of a Gradient, an expression or a constant.
template <class X>
[[nodiscard]] constexpr double compared(const X& x) {
  if constexpr (GradientLike<X>) {
    return x.a;
  } else {
    return x;
  }
}
template <class X, class Y>
concept GradientsCompared = (GradientLike<X> && (GradientLike<Y> || std::is_arithmetic_v<Y>)) ||
                            (std::is_arithmetic_v<X> && GradientLike<Y>);
template <class X, class Y>
requires GradientsCompared<X, Y>
[[nodiscard]] bool operator==(const X& x, const Y& y) {
  return compared(x) == compared(y);
}
template <class X, class Y>
requires GradientsCompared<X, Y>
[[nodiscard]] auto operator<=>(const X& x, const Y& y) {
  return compared(x) <=> compared(y);
}

}  // namespace softgrip::sysid
