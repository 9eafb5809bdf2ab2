#include "sysid/structure/ladder.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

#include "model/exponential.h"
#include "model/segment.h"

namespace softgrip::sysid::ladder_test {
namespace {

/// Steps a ladder and single branches through the same random segments, and compares their states.
void compare(const std::vector<double>& durations_s, std::size_t steps) {
  const std::vector<double> time_constants_s{0.05, 0.2, 3, 40, 500};
  LadderWeights weights(time_constants_s);
  Ladder ladder(weights, 2);
  std::vector<double> states(time_constants_s.size(), 2);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> kpa(0, 60);
  double last = 2;
  for (std::size_t i = 0; i < steps; ++i) {
    const double next = kpa(random);
    const auto segment = model::Segment<double>::straight(durations_s[i % durations_s.size()], last, next);
    ladder.step(segment);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const double rate_hz = 1 / time_constants_s[k];
      const auto w = model::ExponentialWeights<double>::make(segment.duration_s, rate_hz, rate_hz);
      states[k] = w.end(states[k], segment, segment.bend());
      ASSERT_DOUBLE_EQ(ladder.value(k), states[k]) << "step " << i << ", branch " << k;
    }
    last = next;
  }
}

TEST(Ladder, StatesEqualThoseOfSingleBranches) {
  compare({0.01, 0.004, 0.006}, 300);
}

// The number of durations exceeds the number of stored ones, so all stored weights are replaced once.
TEST(Ladder, StatesAreEqualIfEachStepHasADurationOfItsOwn) {
  std::vector<double> durations_s;
  for (int i = 0; i < 20'000; ++i) durations_s.push_back(0.01 + 1e-7 * i);
  compare(durations_s, 2 * durations_s.size());
}

TEST(Ladder, WithoutBranchesNothingHappens) {
  LadderWeights weights({});
  EXPECT_EQ(weights.pairs(), 0U);
  Ladder ladder(weights, 1);
  ladder.step(model::Segment<double>::straight(0.01, 0, 1));
}

}  // namespace
}  // namespace softgrip::sysid::ladder_test
