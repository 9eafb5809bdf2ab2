// Compares every operation of the forward-mode automatic differentiation with central differences.

#include "sysid/fitting/gradient.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace softgrip::sysid::gradient_test {
namespace {

using Number = Gradient<4>;

Number seeded(double value, std::size_t at, double slope) {
  Number x(value);
  x.v.set(at, slope);
  return x;
}

struct Operation {
  std::string name;
  std::function<Number(const Number&, const Number&)> of_numbers;
  std::function<double(double, double)> of_doubles;
};
std::ostream& operator<<(std::ostream& out, const Operation& operation) {
  return out << operation.name;
}

#define SAME(NAME, EXPRESSION)                                        \
  Operation {                                                         \
    NAME,                                                             \
        [](const Number& x, const Number& y) -> Number {              \
          static_cast<void>(y);                                       \
          return EXPRESSION;                                          \
        },                                                            \
        [](double x, double y) -> double {                            \
          static_cast<void>(y);                                       \
          using std::abs, std::exp, std::expm1, std::log;             \
          using std::log1p, std::sqrt, std::sin, std::cos, std::tanh; \
          return EXPRESSION;                                          \
        }                                                             \
  }

std::vector<Operation> operations() {
  return {SAME("Sum", x + y),
          SAME("Difference", x - y),
          SAME("Product", x * y),
          SAME("Quotient", x / y),
          SAME("Negative", -x),
          SAME("PlusConstant", x + 2.0),
          SAME("ConstantPlus", 2.0 + x),
          SAME("MinusConstant", x - 2.0),
          SAME("ConstantMinus", 2.0 - x),
          SAME("TimesConstant", x * 3.0),
          SAME("ConstantTimes", 3.0 * x),
          SAME("OverConstant", x / 3.0),
          SAME("ConstantOver", 3.0 / x),
          SAME("Exp", exp(x)),
          SAME("Expm1", expm1(x)),
          SAME("Log", log(x)),
          SAME("Log1p", log1p(x)),
          SAME("Sqrt", sqrt(x)),
          SAME("Sin", sin(x)),
          SAME("Cos", cos(x)),
          SAME("Tanh", tanh(x)),
          SAME("AbsOfNegative", abs(-x)),
          SAME("Composed", exp(x * y) / (1.0 + x) - sin(y) * y)};
}
#undef SAME

class GradientOf : public ::testing::TestWithParam<Operation> {};

TEST_P(GradientOf, AgreesWithCentralDifferences) {
  const Operation& operation = GetParam();
  constexpr double x = 0.7, y = 1.9, h = 1e-6;
  // The value x depends on the parameters 0 and 3 with the slopes 1 and 2. The value y depends on the
  // parameters 1 and 3 with the slopes 1 and -1.
  Number a = seeded(x, 0, 1), b = seeded(y, 1, 1);
  a.v.set(3, 2);
  b.v.set(3, -1);
  const Number z = operation.of_numbers(a, b);
  const auto& f = operation.of_doubles;
  EXPECT_DOUBLE_EQ(z.a, f(x, y));
  const double by_x = (f(x + h, y) - f(x - h, y)) / (2 * h);
  const double by_y = (f(x, y + h) - f(x, y - h)) / (2 * h);
  EXPECT_NEAR(z.v[0], by_x, 1e-8);
  EXPECT_NEAR(z.v[1], by_y, 1e-8);
  EXPECT_EQ(z.v[2], 0.0);
  EXPECT_NEAR(z.v[3], 2 * by_x - by_y, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Operations, GradientOf, ::testing::ValuesIn(operations()),
                         [](const auto& test) { return test.param.name; });

TEST(Gradient, CompoundAssignmentsMatchTheBinaryOperators) {
  const Number x = seeded(0.7, 0, 1), y = seeded(1.9, 1, 1);
  Number z = x;
  z += y;
  z *= x;
  z -= y;
  z /= y;
  const Number same = ((x + y) * x - y) / y;
  EXPECT_EQ(z.a, same.a);
  EXPECT_TRUE(z.v == same.v);
}

TEST(Gradient, AssignmentSupportsAliasing) {
  const Number x = seeded(0.7, 0, 1), y = seeded(1.9, 3, 1);
  Number z = x;
  z = y - z * z / (z + y);
  const Number other = y - x * x / (x + y);
  EXPECT_EQ(z.a, other.a);
  EXPECT_TRUE(z.v == other.v);
}

TEST(Gradient, ExpressionsCompareByValue) {
  const Number x = seeded(0.7, 0, 1), y = seeded(1.9, 1, 1);
  EXPECT_TRUE(x + y > 2.5);
  EXPECT_TRUE(x * y < y);
  EXPECT_TRUE(y - x == y - x * 1.0);
  EXPECT_FALSE(1.0 >= y);
}

TEST(Gradient, DerivativesAreUnequalIfOneElementDiffers) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(seeded(1, i, 1).v == Number(1.0).v) << i;
  EXPECT_TRUE(seeded(1, 2, 0).v == Number(2.0).v);
}

}  // namespace
}  // namespace softgrip::sysid::gradient_test
