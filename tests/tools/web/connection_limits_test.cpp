#include "tools/web/connection_limits.h"

#include <gtest/gtest.h>

#include <random>

namespace softgrip::web::connection_limits_test {
namespace {

using Kind = ConnectionInfo::Kind;

constexpr Nanoseconds now = 100 * ns_per_s;
constexpr Nanoseconds just = now - 1;
constexpr Nanoseconds long_ago = now - stall_limit - 1;

TEST(ConnectionLimits, ConnectionsUseLessThanHalfOfTheDescriptors) {
  EXPECT_EQ(max_connections_for(64, 1024), 64U);
  EXPECT_EQ(max_connections_for(512, 2048), 512U);
  EXPECT_EQ(max_connections_for(64, 64), 20U);
  EXPECT_EQ(max_connections_for(64, 0), 4U) << "some connections must remain available for requests";
  for (std::size_t descriptors = 32; descriptors < 3000; ++descriptors)
    ASSERT_LT(2 * max_connections_for(512, descriptors), descriptors) << descriptors;
}

TEST(ConnectionLimits, ReservesConnectionsForBriefRequests) {
  for (std::size_t max_connections = 4; max_connections <= 512; ++max_connections)
    EXPECT_LT(max_long_lived(max_connections), max_connections);
}

TEST(ConnectionLimits, ANewClientReplacesTheOneWithTheSlowestRequest) {
  EXPECT_FALSE(victim_for_new_connection({}, now));
  EXPECT_FALSE(victim_for_new_connection({{Kind::receiving, Role::none, just, 0}}, now));
  const std::vector<ConnectionInfo> connections{{Kind::short_lived, Role::look, 0, 0},
                                                {Kind::long_lived, Role::look, 0, 100},
                                                {Kind::receiving, Role::none, long_ago, 0},
                                                {Kind::receiving, Role::none, long_ago - 1, 0}};
  EXPECT_EQ(victim_for_new_connection(connections, now), 3U);
}

TEST(ConnectionLimits, AViewerReplacesNoReadingClientAndNoOperator) {
  const std::vector<ConnectionInfo> connections{
      {Kind::long_lived, Role::look, long_ago, 0},  // an open page, without
                                                    // progress for a long time
      {Kind::long_lived, Role::look, just, 100},    // a download that makes
                                                    // progress
      {Kind::long_lived, Role::operate, long_ago, 100},
      {Kind::short_lived, Role::look, long_ago, 0},
      {Kind::receiving, Role::none, long_ago, 0}};
  EXPECT_FALSE(victim_for_long_lived(connections, Role::look, now));
}

TEST(ConnectionLimits, AViewerReplacesAViewerThatDoesNotRead) {
  const std::vector<ConnectionInfo> connections{{Kind::long_lived, Role::look, long_ago, 100},
                                                {Kind::long_lived, Role::look, long_ago - 1, 1},
                                                {Kind::long_lived, Role::look, just, 100'000}};
  EXPECT_EQ(victim_for_long_lived(connections, Role::look, now), 1U);
}

TEST(ConnectionLimits, AnOperatorReplacesTheMostIdleViewer) {
  const std::vector<ConnectionInfo> connections{{Kind::long_lived, Role::operate, 0, 100},
                                                {Kind::long_lived, Role::look, just, 0},
                                                {Kind::long_lived, Role::look, long_ago, 0}};
  EXPECT_EQ(victim_for_long_lived(connections, Role::operate, now), 2U);
}

TEST(ConnectionLimits, NoClientWithAHigherRoleIsReplaced) {
  constexpr unsigned seed = 478;
  std::mt19937 random(seed);
  std::size_t found = 0;
  for (int turn = 0; turn < 20'000; ++turn) {
    std::vector<ConnectionInfo> connections(random() % 6);
    for (ConnectionInfo& connection : connections) {
      connection = {static_cast<Kind>(random() % 3), static_cast<Role>(random() % 3),
                    now - static_cast<Nanoseconds>(random() % (2 * stall_limit)), random() % 3 * 1000};
    }
    const auto role = static_cast<Role>(random() % 3);
    for (const Victim victim :
         {victim_for_long_lived(connections, role, now), victim_for_memory(connections, role)}) {
      if (!victim) continue;
      ++found;
      ASSERT_LT(*victim, connections.size());
      ASSERT_LE(connections[*victim].role, role) << "seed " << seed << ", turn " << turn;
    }
  }
  EXPECT_GT(found, 5000U);
}

TEST(UnsentBytes, FreesTheBytesOfTheMostIdleClientFirst) {
  EXPECT_FALSE(victim_for_memory({{Kind::long_lived, Role::look, 0, 0}}, Role::operate))
      << "the server has no unsent bytes for this client";
  EXPECT_FALSE(victim_for_memory({{Kind::long_lived, Role::operate, 0, 9}}, Role::look));
  const std::vector<ConnectionInfo> connections{{Kind::long_lived, Role::look, just, 9'000'000},
                                                {Kind::long_lived, Role::look, long_ago, 1000},
                                                {Kind::long_lived, Role::operate, 0, 1000}};
  EXPECT_EQ(victim_for_memory(connections, Role::operate), 1U);
  EXPECT_EQ(total_unsent(connections), 9'002'000U);
}

TEST(UnsentBytes, ReplacesOperatorsUntilTheByteLimitIsMet) {
  std::vector<ConnectionInfo> connections(600,
                                          {Kind::long_lived, Role::operate, just, std::size_t{1} << 20U});
  while (total_unsent(connections) > max_unsent) {
    const Victim victim = victim_for_memory(connections, Role::operate);
    ASSERT_TRUE(victim);
    connections.erase(connections.begin() + static_cast<std::ptrdiff_t>(*victim));
  }
  EXPECT_EQ(connections.size(), 16U);
}

}  // namespace
}  // namespace softgrip::web::connection_limits_test
