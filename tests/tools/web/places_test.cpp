#include "tools/web/places.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace softgrip::web::places_test {
namespace {

using Stay = Guest::Stay;

constexpr Nanoseconds now = 100 * ns_per_s;
constexpr Nanoseconds just = now - 1;
constexpr Nanoseconds long_ago = now - long_pause - 1;

TEST(Places, ConnectionsUseLessThanHalfOfTheDescriptors) {
  EXPECT_EQ(places_for(64, 1024), 64U);
  EXPECT_EQ(places_for(512, 2048), 512U);
  EXPECT_EQ(places_for(64, 64), 20U);
  EXPECT_EQ(places_for(64, 0), 4U) << "some connections must remain available for requests";
  for (std::size_t descriptors = 32; descriptors < 3000; ++descriptors)
    ASSERT_LT(2 * places_for(512, descriptors), descriptors) << descriptors;
}

TEST(Places, ReservesConnectionsForBriefRequests) {
  for (std::size_t places = 4; places <= 512; ++places) EXPECT_LT(lingering_places(places), places);
}

TEST(Places, ANewClientReplacesTheOneWithTheSlowestRequest) {
  EXPECT_FALSE(gives_way_to_newcomer({}, now));
  EXPECT_FALSE(gives_way_to_newcomer({{Stay::asking, Role::none, just, 0}}, now));
  const std::vector<Guest> guests{{Stay::brief, Role::look, 0, 0},
                                  {Stay::lingering, Role::look, 0, 100},
                                  {Stay::asking, Role::none, long_ago, 0},
                                  {Stay::asking, Role::none, long_ago - 1, 0}};
  EXPECT_EQ(gives_way_to_newcomer(guests, now), 3U);
}

TEST(Places, AViewerReplacesNoReadingClientAndNoOperator) {
  const std::vector<Guest> guests{{Stay::lingering, Role::look, long_ago, 0},  // an open page, without
                                                                               // progress for a long time
                                  {Stay::lingering, Role::look, just, 100},    // a download that makes
                                                                               // progress
                                  {Stay::lingering, Role::operate, long_ago, 100},
                                  {Stay::brief, Role::look, long_ago, 0},
                                  {Stay::asking, Role::none, long_ago, 0}};
  EXPECT_FALSE(gives_way_to_lingering(guests, Role::look, now));
}

TEST(Places, AViewerReplacesAViewerThatDoesNotRead) {
  const std::vector<Guest> guests{{Stay::lingering, Role::look, long_ago, 100},
                                  {Stay::lingering, Role::look, long_ago - 1, 1},
                                  {Stay::lingering, Role::look, just, 100'000}};
  EXPECT_EQ(gives_way_to_lingering(guests, Role::look, now), 1U);
}

TEST(Places, AnOperatorReplacesTheMostIdleViewer) {
  const std::vector<Guest> guests{{Stay::lingering, Role::operate, 0, 100},
                                  {Stay::lingering, Role::look, just, 0},
                                  {Stay::lingering, Role::look, long_ago, 0}};
  EXPECT_EQ(gives_way_to_lingering(guests, Role::operate, now), 2U);
}

TEST(Places, NoClientWithAHigherRoleIsReplaced) {
  constexpr unsigned seed = 478;
  std::mt19937 random(seed);
  std::size_t found = 0;
  for (int turn = 0; turn < 20'000; ++turn) {
    std::vector<Guest> guests(random() % 6);
    for (Guest& guest : guests) {
      guest = {static_cast<Stay>(random() % 3), static_cast<Role>(random() % 3),
               now - static_cast<Nanoseconds>(random() % (2 * long_pause)), random() % 3 * 1000};
    }
    const auto role = static_cast<Role>(random() % 3);
    for (const Victim victim :
         {gives_way_to_lingering(guests, role, now), gives_way_for_bytes(guests, role)}) {
      if (!victim) continue;
      ++found;
      ASSERT_LT(*victim, guests.size());
      ASSERT_LE(guests[*victim].role, role) << "seed " << seed << ", turn " << turn;
    }
  }
  EXPECT_GT(found, 5000U);
}

TEST(Bytes, FreesTheBytesOfTheMostIdleClientFirst) {
  EXPECT_FALSE(gives_way_for_bytes({{Stay::lingering, Role::look, 0, 0}}, Role::operate))
      << "this client has no unread bytes";
  EXPECT_FALSE(gives_way_for_bytes({{Stay::lingering, Role::operate, 0, 9}}, Role::look));
  const std::vector<Guest> guests{{Stay::lingering, Role::look, just, 9'000'000},
                                  {Stay::lingering, Role::look, long_ago, 1000},
                                  {Stay::lingering, Role::operate, 0, 1000}};
  EXPECT_EQ(gives_way_for_bytes(guests, Role::operate), 1U);
  EXPECT_EQ(unsent_of(guests), 9'002'000U);
}

TEST(Bytes, ReplacesOperatorsUntilTheByteLimitIsMet) {
  std::vector<Guest> guests(600, {Stay::lingering, Role::operate, just, std::size_t{1} << 20U});
  while (unsent_of(guests) > most_unsent) {
    const Victim victim = gives_way_for_bytes(guests, Role::operate);
    ASSERT_TRUE(victim);
    guests.erase(guests.begin() + static_cast<std::ptrdiff_t>(*victim));
  }
  EXPECT_EQ(guests.size(), 16U);
}

}  // namespace
}  // namespace softgrip::web::places_test
