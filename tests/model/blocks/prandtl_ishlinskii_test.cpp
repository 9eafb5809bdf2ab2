#include "model/blocks/prandtl_ishlinskii.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "model/model.h"
#include "tests/model/drive.h"

namespace softgrip::model::testing::prandtl_ishlinskii_test {
namespace {

using Block = PrandtlIshlinskii<double>;

const std::vector<double> operators{0, 0, 0, 0, 0, 0.2, 2, 0.1, 5, 0.07, 20, 0.05};

Block fresh() {
  return {std::span<const double>(operators), Preparation{}};
}

Segment<double> straight(double from, double to) {
  return Segment<double>::straight(0.01, from, to);
}

TEST(PrandtlIshlinskii, FirstLoadingIsTheInitialCurve) {
  Block block = fresh();
  for (double p = 0; p < 50; p += 0.5) {
    const double wanted =
        0.2 * p + 0.1 * std::max(p - 2, 0.0) + 0.07 * std::max(p - 5, 0.0) + 0.05 * std::max(p - 20, 0.0);
    EXPECT_NEAR(block.output(), wanted, 1e-12) << p;
    block.step(straight(p, p + 0.5), {});
  }
}

TEST(PrandtlIshlinskii, ATrainedFingerFollowsTheCurveOfALaterLoading) {
  std::vector<double> trained = operators;
  trained.front() = 60;
  Block block(std::span<const double>(trained), Preparation{});
  block.reset(0);
  Block loaded_once = fresh();
  loaded_once.step(straight(0, 60), {});
  loaded_once.step(straight(60, 0), {});
  const double zero_mm = loaded_once.output();
  EXPECT_GT(zero_mm, 0) << "after its first load the finger does not return to its initial position";
  for (double p = 0; p < 60; p += 0.5) {
    EXPECT_NEAR(block.output(), loaded_once.output() - zero_mm, 1e-12) << p;
    block.step(straight(p, p + 0.5), {});
    loaded_once.step(straight(p, p + 0.5), {});
  }
}

TEST(PrandtlIshlinskii, UnloadingFollowsMasingsRule) {
  // Masing's rule: after a reversal, the curve is the initial loading curve with both pressure and
  // displacement scaled by the factor 2.
  Block virgin = fresh();
  Block back = fresh();
  back.step(straight(0, 60), {});
  const double at_turn = back.output();
  for (double p = 0; p < 30; p += 0.5) {
    EXPECT_NEAR(at_turn - back.output(), 2 * virgin.output(), 1e-12) << p;
    virgin.step(straight(p, p + 0.5), {});
    back.step(straight(60 - 2 * p, 60 - 2 * p - 1), {});
  }
}

TEST(PrandtlIshlinskii, AClosedInnerLoopHasNoLaterEffect) {
  Block plain = fresh(), looped = fresh();
  for (const auto& [from, to] : {std::pair{0.0, 40.0}, {40.0, 10.0}}) {
    plain.step(straight(from, to), {});
    looped.step(straight(from, to), {});
  }
  for (const auto& [from, to] : {std::pair{10.0, 30.0}, {30.0, 18.0}, {18.0, 25.0}, {25.0, 10.0}})
    looped.step(straight(from, to), {});
  plain.step(straight(10, 5), {});
  looped.step(straight(10, 5), {});
  EXPECT_NEAR(plain.output(), looped.output(), 1e-12);
}

TEST(PrandtlIshlinskii, OutputIsRateIndependent) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> pressure(0, 60);
  Block slow = fresh(), quick = fresh();
  double at = 0;
  for (int i = 0; i < 200; ++i) {
    const double to = pressure(random);
    slow.step(Segment<double>::straight(100, at, to), {});
    quick.step(Segment<double>::straight(0, at, to), {});
    EXPECT_NEAR(slow.output(), quick.output(), 1e-12) << "seed 11, turn " << i;
    at = to;
  }
}

TEST(PrandtlIshlinskii, MeanEqualsTheAverageOverManySmallSteps) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> pressure(0, 60);
  Block whole = fresh(), parts = fresh();
  double at = 0;
  for (int i = 0; i < 50; ++i) {
    const double to = pressure(random);
    const Segment<double> out = whole.step(straight(at, to), {});
    double mean = 0;
    constexpr int count = 2000;
    for (int k = 0; k < count; ++k) {
      const double a = at + (to - at) * k / count, b = at + (to - at) * (k + 1) / count;
      mean += parts.step(Segment<double>::straight(0.01 / count, a, b), {}).mean / count;
    }
    EXPECT_NEAR(out.mean, mean, 1e-9) << "seed 12, turn " << i;
    at = to;
  }
}

TEST(PrandtlIshlinskii, ClosedLoopsProduceNoEnergy) {
  // The pressure never does negative work over a closed hysteresis loop.
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> pressure(0, 60);
  std::vector<double> bent = operators;
  bent[1] = 0.4, bent[2] = 0.2, bent[3] = 50;
  for (int loop = 0; loop < 50; ++loop) {
    Block block = loop % 2 == 0 ? fresh() : Block(std::span<const double>(bent), Preparation{});
    const double low = pressure(random), high = pressure(random);
    double at = 0, work = 0;
    const auto go = [&](double to, bool counts) {
      constexpr int count = 200;
      const double from = at;
      for (int k = 0; k < count; ++k) {
        const double next = from + (to - from) * (k + 1) / count, before = block.output();
        block.step(straight(at, next), {});
        if (counts) work += 0.5 * (at + next) * (block.output() - before);
        at = next;
      }
    };
    go(high, false), go(low, false), go(high, true), go(low, true);
    EXPECT_GE(work, -1e-9) << "seed 13, loop " << loop;
  }
}

/// Generalised play operators must have the same output as ordinary play operators whose input is the
/// envelope function of the pressure.
TEST(PrandtlIshlinskii, NonlinearEnvelopesEqualAMappedPressure) {
  const double bend = 0.3, skew = -0.15, end_kpa = 50;
  const auto seen_kpa = [&](double p) {
    const double x = std::clamp(p / end_kpa, 0.0, 1.0);
    if (p > end_kpa) return end_kpa + (p - end_kpa) * (1 + bend + skew);
    return p * (1 - (1 - x) * (bend - skew * (1 - 2 * x)));
  };
  std::vector<double> values = operators;
  values[0] = 70, values[1] = bend, values[2] = skew, values[3] = end_kpa;
  Block bent(std::span<const double>(values), Preparation{});
  values[0] = seen_kpa(70), values[1] = values[2] = values[3] = 0;
  Block straight_ones(std::span<const double>(values), Preparation{});
  bent.reset(0), straight_ones.reset(0);
  std::mt19937_64 random(14);
  std::uniform_real_distribution<double> pressure(0, 60);
  double at = 0, loudest = 0;
  for (int i = 0; i < 200; ++i) {
    const double to = pressure(random);
    EXPECT_NEAR(bent.peek(0.01, to, {}), straight_ones.peek(0.01, seen_kpa(to), {}), 1e-12);
    bent.step(straight(at, to), {});
    straight_ones.step(straight(seen_kpa(at), seen_kpa(to)), {});
    EXPECT_NEAR(bent.output(), straight_ones.output(), 1e-12) << "seed 14, turn " << i;
    loudest = std::max(loudest, std::abs(seen_kpa(to) - to));
    at = to;
  }
  EXPECT_GT(loudest, 2);
}

TEST(PrandtlIshlinskii, NonlinearEnvelopesAreMonotoneWithinTheirBounds) {
  for (const double bend : {-0.6, 0.0, 0.6}) {
    for (const double skew : {-0.35, 0.0, 0.35}) {
      const EnvelopeMap<double> map(bend, skew, 40);
      for (double p = -10; p < 60; p += 0.01)
        EXPECT_GT(map.value(p + 0.01), map.value(p)) << bend << skew << p;
    }
  }
}

TEST(PrandtlIshlinskii, NonlinearEnvelopesNeedAnEndPressure) {
  EXPECT_FALSE(Block::objection(std::vector<double>{0, 0.1, 0, 0, 0, 0.2}).empty());
  EXPECT_FALSE(Block::objection(std::vector<double>{0, 0, 0.1, 0, 0, 0.2}).empty());
  EXPECT_TRUE(Block::objection(std::vector<double>{0, 0.1, 0.1, 40, 0, 0.2}).empty());
}

TEST(PrandtlIshlinskii, RefusesThresholdsThatDoNotIncrease) {
  EXPECT_TRUE(Block::objection(operators).empty());
  EXPECT_FALSE(Block::objection(std::vector<double>{0, 0, 0, 0, 2, 0.1, 2, 0.2}).empty());
  EXPECT_FALSE(Block::objection(std::vector<double>{0, 0, 0, 0, 5, 0.1, 2, 0.2}).empty());
}

}  // namespace
}  // namespace softgrip::model::testing::prandtl_ishlinskii_test
