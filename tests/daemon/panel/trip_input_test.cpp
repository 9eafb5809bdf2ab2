#include "daemon/panel/trip_input.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace softgrip::daemon::trip_input_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds debounce = 5 * ms;

/// Returns an input that is not tripped, because its contact was released from 0 to 10 ms.
TripInput cleared() {
  TripInput input(debounce);
  input.level(false, 0);
  input.level(false, 10 * ms);
  EXPECT_FALSE(input.tripped());
  return input;
}

TEST(TripInput, IsTrippedUntilClearForTheDebounceTime) {
  TripInput input(debounce);
  EXPECT_TRUE(input.tripped());
  EXPECT_EQ(input.due(), 0) << "the level of the input must be read immediately";
  input.level(false, 1 * ms);
  EXPECT_TRUE(input.tripped());
  EXPECT_EQ(input.due(), 6 * ms);
  input.level(false, 6 * ms - 1);
  EXPECT_TRUE(input.tripped());
  input.level(false, 6 * ms);
  EXPECT_FALSE(input.tripped());
  EXPECT_GT(input.due(), 1'000'000 * ms) << "nothing is pending";
}

TEST(TripInput, StaysTrippedWhilePressedWithNothingPending) {
  TripInput input(debounce);
  for (int i = 0; i < 100; ++i) {
    input.level(true, i * ms);
    EXPECT_TRUE(input.tripped());
  }
  EXPECT_GT(input.due(), 1'000'000 * ms);
}

TEST(TripInput, TripsWhenPressedForTheDebounceTime) {
  TripInput input = cleared();
  input.edge(true, 20 * ms);
  input.level(true, 20 * ms + 100'000);
  EXPECT_FALSE(input.tripped());
  EXPECT_EQ(input.due(), 25 * ms);
  input.level(true, 25 * ms);
  EXPECT_TRUE(input.tripped());
}

TEST(TripInput, IgnoresAPressShorterThanTheDebounceTime) {
  TripInput input = cleared();
  input.edge(true, 20 * ms);
  input.edge(false, 24 * ms);
  for (Nanoseconds now = 24 * ms; now < 60 * ms; now += ms) {
    input.level(false, now);
    EXPECT_FALSE(input.tripped()) << now / ms;
  }
}

TEST(TripInput, DetectsAPressThatEndedBeforeTheReading) {
  TripInput input = cleared();
  input.edge(true, 20 * ms);
  input.edge(false, 26 * ms);
  EXPECT_TRUE(input.tripped()) << "according to the edge times of the kernel, the input was pressed for 6 ms";
}

TEST(TripInput, TripsOnAChatteringContact) {
  TripInput input = cleared();
  bool pressed = false;
  Nanoseconds now = 20 * ms;
  while (!input.tripped() && now < 100 * ms) {
    pressed = !pressed;
    input.edge(pressed, now);
    now += 2 * ms;
    input.level(pressed, now);
  }
  EXPECT_LE(now, 30 * ms + 2 * ms)
      << "the detection takes at most twice the debounce time plus one reading interval";
}

TEST(TripInput, TripsOnLevelsWithoutEdges) {
  TripInput input = cleared();
  input.level(true, 20 * ms);
  input.level(true, 25 * ms);
  EXPECT_TRUE(input.tripped());
}

TEST(TripInput, AnEdgeOlderThanAKnownLevelChangesNothing) {
  TripInput input = cleared();
  input.level(true, 20 * ms);
  input.edge(true, 19 * ms);
  EXPECT_EQ(input.due(), 25 * ms);
}

TEST(TripInput, AReleaseEdgeWithoutAPressEdgeDoesNotTrip) {
  TripInput input = cleared();
  input.edge(false, 20 * ms);  // simulates a release whose preceding edge to "pressed" was lost
  EXPECT_FALSE(input.tripped());
  input.level(false, 25 * ms);
  EXPECT_FALSE(input.tripped());
  EXPECT_GT(input.due(), 1'000'000 * ms);
}

/// Checks the bounds that trip_input.h states with random contact signals. The input must have tripped at the
/// end of an uninterrupted press of at least the debounce time. Shorter presses must not trip it before the
/// contact has bounced for twice the debounce time.
TEST(TripInput, KeepsTheDebounceBoundsOnRandomContacts) {
  constexpr std::uint64_t seed = 20261120;
  std::mt19937_64 random(seed);
  SCOPED_TRACE(seed);
  std::uniform_int_distribution<Nanoseconds> gap(ms / 10, 7 * ms);
  for (int run = 0; run < 2000; ++run) {
    TripInput input = cleared();
    const Nanoseconds begin = 20 * ms;
    bool pressed = false;
    Nanoseconds at = begin;
    Nanoseconds quiet_since = 0;  // time of the last release of the contact [ns]
    Nanoseconds pressed_since = 0;
    bool must_have_tripped = false;
    bool may_have_tripped = false;
    Nanoseconds unquiet_since = begin;
    for (int i = 0; i < 12; ++i) {
      pressed = !pressed;
      if (pressed && at - quiet_since >= debounce) unquiet_since = at;
      if (!pressed && at - pressed_since >= debounce) must_have_tripped = true;
      if (at - unquiet_since >= 2 * debounce && (pressed ? at - quiet_since < debounce : true)) {
        may_have_tripped = true;
      }
      (pressed ? pressed_since : quiet_since) = at;
      input.edge(pressed, at);
      if (must_have_tripped) {
        ASSERT_TRUE(input.tripped()) << "run " << run << " edge " << i;
        break;
      }
      if (!may_have_tripped) {
        ASSERT_FALSE(input.tripped()) << "run " << run << " edge " << i;
      }
      if (input.tripped()) break;
      at += gap(random);
    }
  }
}

}  // namespace
}  // namespace softgrip::daemon::trip_input_test
