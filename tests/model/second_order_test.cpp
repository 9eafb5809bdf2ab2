#include "model/second_order.h"

#include <gtest/gtest.h>

#include "model/segment.h"

namespace softgrip::model::second_order_test {
namespace {

struct State {
  double value = 0, rate = 0;
};

/// Integrates the differential equation over a ramp by the Runge-Kutta method of order 4.
State integrated(State s, double omega, double damping, double begin, double end, double duration_s) {
  constexpr int steps = 400;
  const double h = duration_s / steps;
  const auto slope = [&](const State& at, double t) {
    const double input = begin + (end - begin) * t / duration_s;
    return State{at.rate, omega * omega * (input - at.value) - 2 * damping * omega * at.rate};
  };
  const auto moved = [](const State& from, const State& by, double h_s) {
    return State{from.value + h_s * by.value, from.rate + h_s * by.rate};
  };
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const State a = slope(s, t), b = slope(moved(s, a, h / 2), t + h / 2),
                c = slope(moved(s, b, h / 2), t + h / 2), d = slope(moved(s, c, h), t + h);
    s.value += h / 6 * (a.value + 2 * b.value + 2 * c.value + d.value);
    s.rate += h / 6 * (a.rate + 2 * b.rate + 2 * c.rate + d.rate);
  }
  return s;
}

// More different durations than the object stores, in an order in which durations return after they were
// replaced. Short and long segments, and all kinds of damping.
TEST(SecondOrder, ChangingDurationsGiveTheResponseOfTheDifferentialEquation) {
  constexpr std::array durations_s{0.02, 0.007, 0.02, 0.1, 1e-5, 0.013, 0.02, 0.4, 0.007, 0.05, 1e-5, 0.02};
  constexpr double omega = 6;
  std::size_t compared = 0;
  for (const double damping : {0.05, 0.7, 1.0, 3.0, 40.0}) {
    SecondOrder<double> system(omega, damping);
    system.reset(1);
    State reference{1, 0};
    double input = 1;
    for (std::size_t i = 0; i < 3 * durations_s.size(); ++i) {
      const double duration_s = durations_s[i % durations_s.size()];
      const double next = 2 * std::sin(1.0 + static_cast<double>(i));
      system.advance(Segment<double>::straight(duration_s, input, next));
      reference = integrated(reference, omega, damping, input, next, duration_s);
      input = next;
      EXPECT_NEAR(system.value(), reference.value, 1e-7) << "damping " << damping << ", segment " << i;
      EXPECT_NEAR(system.rate(), reference.rate, 1e-6) << "damping " << damping << ", segment " << i;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 5 * 3 * durations_s.size());
}

}  // namespace
}  // namespace softgrip::model::second_order_test
