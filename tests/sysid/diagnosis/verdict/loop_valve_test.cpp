#include "sysid/diagnosis/verdict/loop_valve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sysid/limits/limits.h"

namespace softgrip::sysid::loop_valve_test {
namespace {

struct Signals {
  std::vector<double> command, reading;
};

constexpr double measured_noise = 0.05;

/// Returns the signals of a loop with an integrating controller and a random load. If `band` is positive, the
/// valve sticks (two-state model of Kano et al. 2004, which the test of softgrip does not use).
Signals loop(double band, double jump, double load_step, unsigned seed, double proportional = 0.1,
             double noise_share = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  Signals signals;
  double stem = 0, rested = 0, flow = 0, load = 0, sum = 0, before = 0, change = 0;
  double direction = 1;
  bool resting = true;
  for (int i = 0; i < 1400; ++i) {
    load += load_step * normal(random);
    const double reading = flow + load + measured_noise * noise_share * normal(random);
    sum += 0.05 * reading;
    const double command = -proportional * reading - sum;
    const double now = command - before;
    if (!resting && now * change <= 0) {
      rested = before;
      resting = true;
    }
    before = command;
    change = now;
    if (resting && direction * (command - rested) < -band) {
      direction = -direction;
      resting = false;
    } else if (resting && direction * (command - rested) > jump) {
      resting = false;
    }
    if (!resting) stem = command - direction * (band - jump) / 2;
    if (band == 0) stem = command;
    flow += 0.6 * (stem - flow);
    if (i < 400) continue;
    signals.command.push_back(command);
    signals.reading.push_back(reading);
  }
  return signals;
}

TEST(LoopValve, TheStemRestsForTheBandAndThenJumps) {
  std::vector<double> command;
  for (int i = 0; i <= 400; ++i) command.push_back(0.1 * (i <= 200 ? i : 400 - i));
  const std::vector<double> stem = stem_positions(command, 4, 1);
  const auto top = std::max_element(stem.begin(), stem.end());
  EXPECT_NEAR(20 - *top, 2, 0.6);  // between (S - J) / 2 and (S + J) / 2
  const auto next = std::find_if(top, stem.end(), [&](double x) { return x < *top; });
  EXPECT_NEAR(*top - *next, 1, 0.15);
  EXPECT_EQ(stem_positions(command, 0, 0), command);
}

TEST(LoopValve, AStickingValveIsFoundWithItsBand) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Signals s = loop(2, 1, 0.01, seed);
    const auto found = best_sticking_stem(s.command, s.reading);
    ASSERT_TRUE(found) << seed;
    EXPECT_GT(found->log_likelihood_ratio, limits::strict_log_likelihood) << seed;
    EXPECT_NEAR(found->band, 2, 1) << seed;
  }
}

TEST(LoopValve, AFreeValveUnderARandomLoadIsNoStickingValve) {
  int odd = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Signals s = loop(0, 0, 0.05, seed);
    const auto found = best_sticking_stem(s.command, s.reading);
    odd += found && found->log_likelihood_ratio > limits::strict_log_likelihood ? 1 : 0;
  }
  EXPECT_EQ(odd, 0);
}

/// A deadband that is smaller than the noise of the command would act like a filter against the noise.
TEST(LoopValve, TheBandExceedsTheNoiseOfTheCommand) {
  const Signals s = loop(0, 0, 0.02, 3, 1.5, 4);
  const auto found = best_sticking_stem(s.command, s.reading);
  const auto [low, high] = std::minmax_element(s.command.begin(), s.command.end());
  EXPECT_TRUE(!found || found->band > 0.25 * (*high - *low));
}

TEST(LoopValve, OtherExplanationsReduceTheLikelihoodRatio) {
  const Signals s = loop(2, 1, 0.01, 1);
  const auto ratio = [&](const OtherExplanations& others) {
    return best_sticking_stem(s.command, s.reading, others).value().log_likelihood_ratio;
  };
  const double alone = ratio({});
  EXPECT_LE(ratio({true, {}}), alone);
  // A response that nearly predicts the next reading is the best explanation.
  std::vector<double> next(s.reading.begin() + 1, s.reading.end());
  next.push_back(s.reading.back());
  for (std::size_t i = 0; i < next.size(); i += 2) next[i] += 0.01;
  EXPECT_LT(ratio({false, next}), 0);
  EXPECT_EQ(ratio({false, std::vector<double>(s.reading.size(), 1.0)}), alone);
}

TEST(LoopValve, ACompressedRecordIsNotTested) {
  Signals s = loop(2, 1, 0.01, 1);
  ASSERT_TRUE(best_sticking_stem(s.command, s.reading));
  for (std::size_t i = 0; i < s.reading.size(); ++i) s.reading[i] = s.reading[i - i % 3];
  EXPECT_FALSE(best_sticking_stem(s.command, s.reading));
}

TEST(LoopValve, ShortAndConstantSeriesAreNotTested) {
  const Signals s = loop(2, 1, 0.01, 1);
  const std::vector<double> few(s.command.begin(), s.command.begin() + 150);
  EXPECT_FALSE(best_sticking_stem(few, few));
  EXPECT_FALSE(best_sticking_stem(std::vector<double>(s.reading.size(), 1.0), s.reading));
}

}  // namespace
}  // namespace softgrip::sysid::loop_valve_test
