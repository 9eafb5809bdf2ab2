#include "control/elements/limit_watch.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softgrip::control {
namespace {

constexpr double tick_s = 0.005;

/// What is told while `binds(time)` says what keeps the command down.
template <class Binds>
std::vector<std::string> told(double seconds, Binds&& binds) {
  LimitWatch watch;
  std::vector<std::string> all;
  for (double t = 0; t < seconds; t += tick_s) {
    if (const auto now = watch.observe(t, binds(t))) all.emplace_back(name_of(*now));
  }
  return all;
}

TEST(LimitWatch, AMomentIsNotTold) {
  EXPECT_TRUE(told(2, [](double t) {
                return t > 0.5 && t < 0.9 ? UpperLimit::rig_pressure : UpperLimit::none;
              }).empty());
}

TEST(LimitWatch, WhatLastsIsToldOnceAndSoIsItsEnd) {
  const auto all =
      told(5, [](double t) { return t > 1 && t < 4 ? UpperLimit::step_squeeze : UpperLimit::none; });
  EXPECT_EQ(all, (std::vector<std::string>{"step_squeeze", "none"}));
}

TEST(LimitWatch, NoiseAcrossTheCeilingIsOneLimit) {
  int tick = 0;
  const auto all = told(
      5, [&](double t) { return t < 3 && ++tick % 3 == 0 ? UpperLimit::step_pressure : UpperLimit::none; });
  EXPECT_EQ(all, (std::vector<std::string>{"step_pressure", "none"}));
}

}  // namespace
}  // namespace softgrip::control
