#include "tools/plc/client_connections.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/periodic_schedule.h"

namespace softgrip::plc::client_connections_test {
namespace {

constexpr Nanoseconds minute = 60 * ns_per_s;

class ClientConnectionsTest : public ::testing::Test {
 protected:
  ClientConnections::Id connect(const std::string& address = "10.0.0.1") {
    const auto id = connections_.admit(address, now_);
    EXPECT_TRUE(id.has_value());
    return id.value_or(0);
  }
  void request(ClientConnections::Id id) {
    connections_.find(id)->has_requested = true;
    connections_.find(id)->last_request_at = now_;
  }

  ClientConnections connections_{3};
  Nanoseconds now_ = ns_per_s;
};

TEST_F(ClientConnectionsTest, ANewConnectionReplacesTheMostIdleOneOfTheAddress) {
  std::vector<ClientConnections::Id> dead;
  for (int i = 0; i < 3; ++i) {
    dead.push_back(connect());
    request(dead.back());
    now_ += ns_per_s;
  }
  const ClientConnections::Id alive = connect();
  EXPECT_FALSE(connections_.has(dead[0]));
  EXPECT_TRUE(connections_.has(dead[1]));
  EXPECT_TRUE(connections_.has(alive));
  now_ += ns_per_s;
  request(alive);
  connect();
  EXPECT_FALSE(connections_.has(dead[1]));
  EXPECT_TRUE(connections_.has(alive));
}

TEST_F(ClientConnectionsTest, AnActiveConnectionIsNotReplaced) {
  const ClientConnections::Id plc = connect();
  std::size_t admitted = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i % 10 == 0) request(plc);
    admitted += connections_.admit("10.0.0.1", now_) ? 1U : 0U;
    EXPECT_TRUE(connections_.has(plc));
    EXPECT_LE(connections_.all().size(), 3U);
    now_ += ns_per_s / 11;
  }
  EXPECT_GT(admitted, 100U);
}

TEST_F(ClientConnectionsTest, ReplacesAConnectionWithoutRequestsFirst) {
  const ClientConnections::Id plc = connect();
  request(plc);
  now_ += ns_per_s;
  const ClientConnections::Id first = connect();
  const ClientConnections::Id second = connect();
  now_ += ns_per_s;
  connect();
  EXPECT_TRUE(connections_.has(plc) && connections_.has(second));
  EXPECT_FALSE(connections_.has(first));
}

TEST_F(ClientConnectionsTest, ConnectionsWithoutRequestsDoNotReplaceAnIdleClient) {
  const ClientConnections::Id plc = connect();
  request(plc);
  for (int i = 0; i < 1000; ++i) {
    now_ += ns_per_s / 20;
    static_cast<void>(connections_.admit("10.0.0.1", now_));
    EXPECT_TRUE(connections_.has(plc));
  }
}

TEST_F(ClientConnectionsTest, RefusesAConnectionIfNoConnectionIsIdle) {
  for (int i = 0; i < 3; ++i) request(connect());
  EXPECT_FALSE(connections_.admit("10.0.0.1", now_));
  now_ += ns_per_s;
  EXPECT_TRUE(connections_.admit("10.0.0.1", now_));
}

TEST_F(ClientConnectionsTest, ConnectionsOfOneAddressDoNotReplaceAnotherAddress) {
  const ClientConnections::Id other = connect("10.0.0.2");
  connect();
  connect();
  for (int i = 0; i < 10; ++i) {
    now_ += minute;
    connect();
  }
  EXPECT_TRUE(connections_.has(other));
}

TEST_F(ClientConnectionsTest, ANewAddressReplacesAConnectionOfTheLargestAddress) {
  const ClientConnections::Id first = connect("10.0.0.2");
  const ClientConnections::Id second = connect("10.0.0.2");
  const ClientConnections::Id other = connect("10.0.0.3");
  for (const ClientConnections::Id id : {first, second, other}) request(id);
  const ClientConnections::Id plc = connect();
  EXPECT_FALSE(connections_.has(first));
  EXPECT_TRUE(connections_.has(second) && connections_.has(other) && connections_.has(plc));
  // Each address has one connection at this point, and the largest number of connections is reached.
  EXPECT_FALSE(connections_.admit("10.0.0.4", now_));
}

TEST_F(ClientConnectionsTest, ClosesAConnectionWithoutRequestsAfterTheTimeOut) {
  const ClientConnections::Id silent = connect();
  const ClientConnections::Id plc = connect();
  now_ += minute - 1;
  request(plc);
  connections_.drop_idle(now_, minute);
  EXPECT_TRUE(connections_.has(silent));
  ++now_;
  connections_.drop_idle(now_, minute);
  EXPECT_FALSE(connections_.has(silent));
  EXPECT_TRUE(connections_.has(plc));
}

TEST_F(ClientConnectionsTest, ClosesOtherConnectionsWithIncompleteRequests) {
  const ClientConnections::Id complete = connect();
  const ClientConnections::Id partial = connect();
  const ClientConnections::Id writer = connect("10.0.0.2");
  connections_.find(partial)->partial_request = true;
  connections_.find(writer)->partial_request = true;
  connections_.drop_partial_requests(writer);
  EXPECT_TRUE(connections_.has(complete) && connections_.has(writer));
  EXPECT_FALSE(connections_.has(partial));
}

TEST_F(ClientConnectionsTest, ANewConnectionContinuesTheCounterOfTheAddress) {
  const ClientConnections::Id first = connect();
  EXPECT_FALSE(connections_.find(first)->cursor.at);
  connections_.find(first)->cursor.at = 7;
  connections_.remember_counter(*connections_.find(first));
  connections_.remove(first);
  const ClientConnections::Id again = connect();
  EXPECT_EQ(connections_.find(again)->cursor.at, 7);
  EXPECT_FALSE(connections_.find(connect("10.0.0.2"))->cursor.at);
}

TEST_F(ClientConnectionsTest, LosingSynchronisationAffectsAllConnectionsOfTheAddress) {
  const ClientConnections::Id first = connect();
  const ClientConnections::Id other = connect("10.0.0.2");
  for (const ClientConnections::Id id : {first, other}) {
    connections_.find(id)->cursor.at = 7;
    connections_.remember_counter(*connections_.find(id));
  }
  const ClientConnections::Id second = connect();
  connections_.require_resynchronisation("10.0.0.1");
  EXPECT_FALSE(connections_.find(first)->cursor.at);
  EXPECT_FALSE(connections_.find(second)->cursor.at);
  EXPECT_EQ(connections_.find(other)->cursor.at, 7);
  connections_.remove(second);
  EXPECT_FALSE(connections_.find(connect())->cursor.at);
}

TEST_F(ClientConnectionsTest, AHeartbeatIsAChangedValueOnOneConnection) {
  const ClientConnections::Id first = connect();
  const ClientConnections::Id second = connect();
  const ClientConnections::Id other = connect("10.0.0.2");
  const auto changes = [&](ClientConnections::Id id, std::uint16_t value) {
    return connections_.update_heartbeat(*connections_.find(id), value);
  };
  EXPECT_FALSE(changes(first, 0));  // no change, because the register contains 0 from the start
  EXPECT_TRUE(changes(first, 5));
  EXPECT_FALSE(changes(second, 5));  // no change, because the two connections belong to the same master
  EXPECT_TRUE(changes(second, 6));
  EXPECT_FALSE(changes(first, 5));
  EXPECT_FALSE(changes(second, 6));
  EXPECT_TRUE(changes(other, 6));
}

TEST(ClientRegisters, ContainsNoCommandInitially) {
  ClientConnection connection;
  EXPECT_EQ(command_in(connection.registers), Command{});
  at(connection.registers, Name::command) = 1;
  at(connection.registers, Name::displacement) = 12;
  EXPECT_EQ(command_in(connection.registers), (Command{1, 0, no_value, no_value, 12}));
}

}  // namespace
}  // namespace softgrip::plc::client_connections_test
