#include "tools/web/access/sessions.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace softgrip::web::sessions_test {
namespace {

constexpr Grant look{Role::look, 0};
constexpr Grant operate{Role::operate, 1};

TEST(Sessions, ANewSessionReplacesTheMostIdleOneOfTheToken) {
  Sessions sessions(100, 1000);
  const std::string first = sessions.open(look, 0);
  const std::string second = sessions.open(look, 1);
  for (std::size_t i = 2; i < Sessions::most_per_token; ++i) static_cast<void>(sessions.open(look, 2));
  EXPECT_EQ(sessions.role_of(first, 3), Role::look);
  static_cast<void>(sessions.open(look, 4));
  EXPECT_EQ(sessions.size(), Sessions::most_per_token);
  EXPECT_EQ(sessions.role_of(second, 5), Role::none);
  EXPECT_EQ(sessions.role_of(first, 5), Role::look);
}

TEST(Sessions, AClosedSessionDoesNotCountTowardsTheLimit) {
  Sessions sessions(100, 1000);
  const std::string closed = sessions.open(look, 0);
  const std::string kept = sessions.open(look, 1);
  for (std::size_t i = 2; i < Sessions::most_per_token; ++i) static_cast<void>(sessions.open(look, 2));
  sessions.close(closed);
  static_cast<void>(sessions.open(look, 3));
  EXPECT_EQ(sessions.role_of(kept, 4), Role::look);
}

TEST(Sessions, SessionsOfOneTokenDoNotEndThoseOfAnotherToken) {
  constexpr unsigned seed = 47;
  std::mt19937 random(seed);
  constexpr Nanoseconds long_enough = 1'000'000;
  Sessions sessions(long_enough, long_enough);
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < Sessions::most_per_token; ++i) kept.push_back(sessions.open(operate, 0));
  std::vector<std::string> others;
  for (Nanoseconds now = 1; now < 3000; ++now) {
    const Grant other{random() % 2 == 0 ? Role::look : Role::operate, 2 + random() % 3};
    others.push_back(sessions.open(other, now));
    if (random() % 4 == 0) sessions.close(others[random() % others.size()]);
    ASSERT_LE(sessions.size(), 4 * Sessions::most_per_token);
  }
  for (const std::string& id : kept) EXPECT_EQ(sessions.role_of(id, 3000), Role::operate) << "seed " << seed;
}

}  // namespace
}  // namespace softgrip::web::sessions_test
