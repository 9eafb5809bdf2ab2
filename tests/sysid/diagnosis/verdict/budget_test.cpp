#include "sysid/diagnosis/verdict/budget.h"

#include <gtest/gtest.h>

namespace softgrip::sysid::budget_test {
namespace {

Diagnosis errors_mm(double as_given, double recalibrated, double extended, double noise) {
  Diagnosis d;
  d.as_given_rmse_mm = as_given;
  d.recalibrated_rmse_mm = recalibrated;
  d.extended_rmse_mm = extended;
  d.noise_mm = noise;
  return d;
}

NamedCause worth_mm2(double gain) {
  NamedCause named;
  named.gain_mm2.value = gain;
  return named;
}

TEST(Budget, IsInSquareMillimetres) {
  const Budget budget = budget_of(errors_mm(0.5, 0.3, 0.1, 0.05));
  EXPECT_DOUBLE_EQ(budget.as_given, 0.25);
  EXPECT_DOUBLE_EQ(budget.excess(), 0.09 - 0.0025);
  EXPECT_DOUBLE_EQ(budget.left(), 0.01 - 0.0025);
}

TEST(Budget, WhatIsBelowTheNoiseIsNothing) {
  const Budget budget = budget_of(errors_mm(0.05, 0.04, 0.03, 0.05));
  EXPECT_EQ(budget.excess(), 0);
  EXPECT_EQ(budget.left(), 0);
  EXPECT_EQ(budget.share_percent(worth_mm2(0.01)), 0)
      << "if the mean square error is 0, every share must be 0";
}

TEST(Budget, AShareStaysWithinTheWhole) {
  const Budget budget = budget_of(errors_mm(0.5, 0.3, 0.1, 0));
  EXPECT_DOUBLE_EQ(budget.share_percent(worth_mm2(0.045)), 50);
  EXPECT_EQ(budget.share_percent(worth_mm2(1)), 100);
  EXPECT_EQ(budget.share_percent(worth_mm2(-1)), 0) << "the held-out error is smaller without the cause";
}

}  // namespace
}  // namespace softgrip::sysid::budget_test
