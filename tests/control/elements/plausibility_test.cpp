#include "control/elements/plausibility.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::control::plausibility_test {
namespace {

using model::Reading;
using model::Validity;

constexpr Nanoseconds tick_ns = 5'000'000;
constexpr PlausibilitySettings typical{0.03, 200, 0.5, 0.5, 0, 10, 2};

struct Channel {
  Plausibility judge{typical};
  Nanoseconds now = 1'000'000'000;
  std::uint32_t sequence = 0;

  Validity next(double displacement_mm, double command_kpa = 0, Nanoseconds age = tick_ns,
                double expected_mm = 0) {
    now += tick_ns;
    Reading reading;
    reading.displacement_mm = displacement_mm;
    reading.sampled_at = now - age;
    reading.sequence = ++sequence;
    reading.validity = Validity::valid;
    return judge.judge(reading, now, command_kpa, expected_mm);
  }
};

TEST(Plausibility, ASmoothlyMovingReadingIsValid) {
  Channel channel;
  for (int i = 0; i < 1000; ++i)
    ASSERT_EQ(channel.next(5 + 0.5 * std::sin(0.05 * i), 0.01 * i), Validity::valid);
}

TEST(Plausibility, KeepsTheValidityThatTheDriverReported) {
  Plausibility judge(typical);
  Reading reading;
  EXPECT_EQ(judge.judge(reading, 5, 0), Validity::none_yet);
  reading.validity = Validity::sensor_error;
  EXPECT_EQ(judge.judge(reading, 5, 0), Validity::sensor_error);
}

TEST(Plausibility, ANaNReadingIsOutOfRange) {
  Channel channel;
  EXPECT_EQ(channel.next(std::numeric_limits<double>::quiet_NaN()), Validity::out_of_range);
}

TEST(Plausibility, AnOldReadingIsStale) {
  Channel channel;
  EXPECT_EQ(channel.next(5, 0, 30'000'000), Validity::valid);
  EXPECT_EQ(channel.next(5, 0, 30'000'001), Validity::stale);
  EXPECT_EQ(channel.next(5), Validity::valid);
}

TEST(Plausibility, AJumpIsInvalidUntilTheSpeedLimitPermitsTheMotion) {
  Channel channel;
  EXPECT_EQ(channel.next(5), Validity::valid);
  EXPECT_EQ(channel.next(6.4), Validity::valid)
      << "the permitted change of the reading is 200 mm/s for 5 ms plus the margin";
  EXPECT_EQ(channel.next(12), Validity::jumped);
  EXPECT_EQ(channel.next(6.4), Validity::valid) << "after a single spike, the next reading is valid";
  EXPECT_EQ(channel.next(12), Validity::jumped);
  int ticks = 1;
  while (channel.next(12) == Validity::jumped) ++ticks;
  EXPECT_EQ(ticks, 5) << "the jump exceeds the margin by 5.1 mm, which takes 25.5 ms at 200 mm/s";
}

TEST(Plausibility, AFrozenReadingIsFoundOnlyWhileTheCommandMoves) {
  Channel still;
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(still.next(5, 20), Validity::valid);

  Channel moving;
  int valid = 0;
  for (int i = 0; i < 200; ++i) valid += moving.next(5, 0.2 * i) == Validity::valid;
  EXPECT_EQ(valid, 100) << "a frozen reading is valid for 0.5 s, which are 100 ticks of 5 ms";
  EXPECT_EQ(moving.next(5.001, 40), Validity::valid) << "the reading moves again";
}

// If a part stops a finger, the displacement is constant, but the noise of the sensor still changes the
// reading. If the reading of a sensor that normally has noise is constant, the reading is frozen.
TEST(Plausibility, ANoisySensorIsFrozenIfConstantWhileTheModelMoves) {
  for (const bool lively : {true, false}) {
    Channel channel;
    for (int i = 0; i < 1000; ++i) (void)channel.next(5 + 0.01 * ((lively ? i : i / 40) % 3));
    int valid = 0;
    double moved_mm = 0;
    for (int i = 0; i < 200; ++i) {
      moved_mm = std::min(3.0, 0.05 * i);
      valid += channel.next(5.005, 20, tick_ns, 5 + moved_mm) == Validity::valid;
      EXPECT_FALSE(i < 10 && channel.judge.stands_still())
          << "within the first 50 ms no reading counts as constant";
      EXPECT_FALSE(i == 30 && channel.judge.stands_still() != lively)
          << "after 150 ms only the reading of a sensor that normally has noise counts as constant";
    }
    EXPECT_EQ(valid, lively ? 100 : 200)
        << "a frozen reading is valid for 0.5 s, which are 100 ticks of 5 ms";
    (void)channel.next(5.01, 20, tick_ns, 8);
    EXPECT_FALSE(channel.judge.stands_still());
  }
}

TEST(Plausibility, AConstantReadingIsNotFrozenIfTheModelMovesUnder2Mm) {
  Channel channel;
  for (int i = 0; i < 1000; ++i) (void)channel.next(5 + 0.01 * (i % 3));
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(channel.next(5.005, 20, tick_ns, 5 + 1.9e-3 * i), Validity::valid);
  }
}

TEST(Plausibility, AReadingThatChangesWithinTheFreezeTimeIsValid) {
  Channel channel;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_EQ(channel.next(i / 90 % 2 == 0 ? 5 : 5.01, 0.05 * i), Validity::valid) << i;
  }
}

}  // namespace
}  // namespace softgrip::control::plausibility_test
