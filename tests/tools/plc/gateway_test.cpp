#include "tools/plc/gateway.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <filesystem>
#include <string>

#include "base/files.h"
#include "base/net/listener.h"
#include "base/periodic_schedule.h"
#include "tests/tools/daemon_lines.h"
#include "tools/client/daemon_client.h"
#include "tools/plc/server.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace softgrip::plc::gateway_test {
namespace {

using Json = nlohmann::ordered_json;

/// Tests the PLC gateway with several Modbus clients (masters). The test determines the responses of the
/// daemon.
class GatewayTest : public ::testing::Test {
 protected:
  static Settings shipped() {
    document::Problems problems;
    return *load_settings(SOFTGRIP_SOURCE_DIR "/config/plc.yaml", problems);
  }
  ClientConnections::Id connect(const std::string& address = "127.0.0.1") {
    return *gateway_.connections().admit(address, now_);
  }
  void write(ClientConnections::Id id, Name first, const std::vector<std::uint16_t>& values) {
    modbus::Request request{1, 1, {16}};
    modbus::append_word(request.pdu, settings_.registers.at(first));
    modbus::append_word(request.pdu, static_cast<std::uint16_t>(values.size()));
    request.pdu.push_back(static_cast<std::uint8_t>(2 * values.size()));
    for (const std::uint16_t value : values) modbus::append_word(request.pdu, value);
    static_cast<void>(gateway_.serve(id, request, now_));
    if (!pipelined_) gateway_.on_requests_served(id);
  }
  void write(Name name, std::uint16_t value) { write(plc_, name, {value}); }
  /// Writes a command and its counter in one block of registers, as a master does.
  void put(ClientConnections::Id id, std::uint16_t counter, CommandCode command) {
    write(id, Name::command_counter, {counter, static_cast<std::uint16_t>(command), 1});
  }
  std::uint16_t read(ClientConnections::Id id, Name name) {
    modbus::Request request{1, 1, {3}};
    modbus::append_word(request.pdu, settings_.registers.at(name));
    modbus::append_word(request.pdu, 1);
    const modbus::Reply reply = gateway_.serve(id, request, now_);
    if (!pipelined_) gateway_.on_requests_served(id);
    const modbus::Bytes& frame = reply.pieces.at(0).bytes;
    return modbus::word_at(frame, frame.size() - 2);
  }
  std::uint16_t read(Name name) { return read(plc_, name); }
  /// Returns the outcome and the reason that the gateway shows on this connection.
  std::pair<Outcome, Reason> end_of(ClientConnections::Id id) {
    return {static_cast<Outcome>(read(id, Name::outcome)), static_cast<Reason>(read(id, Name::reason))};
  }

  void daemon_comes() {
    gateway_.on_daemon_connected(now_);
    EXPECT_EQ(sent(), (std::vector<std::string>{"hello", "watch"}));
  }
  /// The daemon connects while a stop is required. The stop is the first line, because a daemon without a
  /// free connection processes only this line. Later, accept() and refuse() answer the stop.
  void daemon_comes_and_gets_the_stop() {
    gateway_.on_daemon_connected(now_);
    const std::vector<Json> lines = gateway_.take_lines_to_daemon();
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0]["command"], "stop");
    EXPECT_EQ(lines[1]["command"], "hello");
    EXPECT_EQ(lines[2]["command"], "watch");
    last_id_ = lines[0]["id"];
  }
  /// Returns the commands that the gateway has sent to the daemon since the last call.
  std::vector<std::string> sent() {
    std::vector<std::string> commands;
    for (const Json& line : gateway_.take_lines_to_daemon()) {
      commands.push_back(line["command"]);
      last_id_ = line["id"];
    }
    return commands;
  }
  void accept() { gateway_.on_daemon_line({{"id", last_id_}, {"ok", true}}, now_); }
  void refuse(const Json& error) {
    gateway_.on_daemon_line({{"id", last_id_}, {"ok", false}, {"error", error}}, now_);
  }
  void say_status() {
    gateway_.on_daemon_line(Json::parse(R"({"id": 2, "watch": {"state": "idle", "result": "-", "fault": null,
      "sequence": null, "channels": []}})"),
                            now_);
  }
  /// Advances the time in steps, as the server does, and calls the gateway in each step. If `daemon_speaks`
  /// is true, the daemon sends its state in each step.
  void pass(double duration_s, bool daemon_speaks = true) {
    for (const Nanoseconds end = now_ + nanoseconds(duration_s); now_ < end;) {
      now_ += Gateway::max_update_period;
      if (daemon_speaks) say_status();
      gateway_.update(now_);
    }
  }

  Settings settings_ = shipped();
  Gateway gateway_{settings_};
  Nanoseconds now_ = 100 * ns_per_s;
  /// True: the requests arrive together, so the gateway does not know that the master has read a response.
  bool pipelined_ = false;
  ClientConnections::Id plc_ = connect();
  std::uint64_t last_id_ = 0;
};

TEST_F(GatewayTest, RefusesEachCommandOnceWithoutADaemon) {
  write(Name::command_counter, 0);
  gateway_.update(now_);
  EXPECT_TRUE(sent().empty());
  write(Name::command, 3);
  EXPECT_EQ(read(Name::outcome), static_cast<int>(Outcome::none));
  write(Name::command_counter, 1);
  EXPECT_EQ(read(Name::done_counter), 1);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::no_daemon));
  write(Name::command, 77);
  write(Name::command_counter, 2);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::no_such_command));
}

/// The fuzz target aborts if a checked property does not hold, and the test then fails.
TEST(PlcRequests, CompleteAndTruncatedFuzzSeedsViolateNoProperty) {
  std::size_t seeds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SOFTGRIP_SOURCE_DIR "/tests/tools/plc/plc_request_corpus")) {
    const std::string seed = *read_file(entry.path(), 65536);
    for (std::size_t length = 0; length <= seed.size(); ++length)
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(seed.data()), length);
    ++seeds;
  }
  EXPECT_GE(seeds, 5U);
}

TEST_F(GatewayTest, TheHeartbeatRegisterCountsTenPerSecond) {
  const std::uint16_t before = read(Name::heartbeat);
  now_ += ns_per_s;
  EXPECT_EQ(read(Name::heartbeat), before + 10);
}

TEST_F(GatewayTest, AnOldBlockOnASecondConnectionIsRefused) {
  daemon_comes();
  const ClientConnections::Id second = connect();
  put(plc_, 0, CommandCode::none);
  put(plc_, 1, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
  accept();
  put(plc_, 2, CommandCode::vent);
  EXPECT_EQ(sent(), std::vector<std::string>{"vent"});
  accept();
  put(second, 1, CommandCode::start);
  EXPECT_TRUE(sent().empty());
  // On the connection whose command was refused, the gateway shows the reason. On the other connection, it
  // shows the outcome of the executed command.
  EXPECT_EQ(end_of(second), std::pair(Outcome::refused, Reason::not_next));
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::accepted, Reason::none));
  EXPECT_EQ(read(second, Name::done_counter), 2);
  put(second, 2, CommandCode::none);
  EXPECT_EQ(end_of(second), std::pair(Outcome::accepted, Reason::none));
  put(second, 3, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

TEST_F(GatewayTest, ACommandThatWasRefusedOnOneConnectionIsNotExecutedOnAnother) {
  daemon_comes();
  const ClientConnections::Id second = connect();
  put(plc_, 0, CommandCode::none);
  put(second, 1, CommandCode::start);  // refused, because this connection has not written the newest counter
  EXPECT_EQ(end_of(second), std::pair(Outcome::refused, Reason::not_next));
  put(plc_, 1, CommandCode::start);
  EXPECT_TRUE(sent().empty());
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::not_next));
  put(plc_, 0, CommandCode::none);
  put(plc_, 1, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

TEST_F(GatewayTest, AStartThatIsOlderThanARefusedVentIsNotExecuted) {
  daemon_comes();
  const ClientConnections::Id second = connect();
  put(plc_, 0, CommandCode::none);
  put(second, 0, CommandCode::none);
  put(second, 2, CommandCode::vent);  // the vent is refused, because the start with counter 1 has not arrived
                                      // yet
  EXPECT_EQ(end_of(second), std::pair(Outcome::refused, Reason::not_next));
  put(plc_, 1, CommandCode::start);
  EXPECT_TRUE(sent().empty());
  put(second, 0, CommandCode::none);
  put(second, 1, CommandCode::vent);
  EXPECT_EQ(sent(), std::vector<std::string>{"vent"});
}

TEST_F(GatewayTest, RegistersOfTwoClientsAreNotCombinedIntoOneCommand) {
  daemon_comes();
  const ClientConnections::Id second = connect("127.0.0.2");
  put(plc_, 0, CommandCode::none);
  write(Name::command, 3);               // the first master prepares a vent without a new counter
  write(second, Name::command, {1, 1});  // the second master prepares a start without a new counter
  EXPECT_EQ(read(Name::command), 3);
  write(Name::command_counter, 1);
  EXPECT_EQ(sent(), std::vector<std::string>{"vent"});
}

TEST_F(GatewayTest, AWriteDropsConnectionsWithIncompleteRequests) {
  const ClientConnections::Id partial = connect();
  gateway_.connections().find(partial)->partial_request = true;
  static_cast<void>(read(Name::state));
  EXPECT_TRUE(gateway_.connections().has(partial));
  write(Name::command, 3);
  EXPECT_FALSE(gateway_.connections().has(partial));
  EXPECT_TRUE(gateway_.connections().has(plc_));
}

TEST_F(GatewayTest, AHeartbeatTimeOutStopsAndForbidsStartsUntilConfirmed) {
  daemon_comes();
  EXPECT_EQ(read(Name::master), 0);
  write(Name::master_heartbeat, 5);
  EXPECT_EQ(read(Name::master), 1);
  pass(settings_.silence_s + 0.1);
  EXPECT_EQ(read(Name::master), 2);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
  write(Name::command_counter, 0);
  put(plc_, 1, CommandCode::start);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::client_silent));
  write(Name::master_heartbeat, 6);
  EXPECT_EQ(read(Name::master), 2);  // the master counts as silent until the daemon has confirmed the stop
  accept();
  EXPECT_EQ(read(Name::master), 1);
  put(plc_, 2, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

TEST_F(GatewayTest, ConstantValuesOnTwoConnectionsAreNoHeartbeat) {
  daemon_comes();
  const ClientConnections::Id second = connect();
  write(plc_, Name::master_heartbeat, {5});
  write(second, Name::master_heartbeat, {9});
  for (int i = 0; i < 30; ++i) {
    pass(0.1);
    write(plc_, Name::master_heartbeat, {5});
    write(second, Name::master_heartbeat, {9});
  }
  EXPECT_EQ(read(Name::master), 2);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
}

TEST_F(GatewayTest, AStartThatWasSentBeforeTheSilenceStaysRefusedBehindAnotherRequest) {
  daemon_comes();
  write(Name::command_counter, 0);
  write(Name::master_heartbeat, 5);
  pass(settings_.silence_s + 0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
  accept();
  // The heartbeat and the start were sent one after the other without waiting for a response, and both were
  // delayed beyond the stop.
  pipelined_ = true;
  write(Name::master_heartbeat, 6);
  put(plc_, 1, CommandCode::start);
  EXPECT_TRUE(sent().empty());
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::client_silent));
  gateway_.on_requests_served(plc_);
  put(plc_, 2, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

TEST_F(GatewayTest, EachMasterHasItsOwnHeartbeat) {
  daemon_comes();
  const ClientConnections::Id standby = connect("127.0.0.2");
  write(Name::master_heartbeat, 5);
  write(standby, Name::command_counter, {0});
  for (std::uint16_t beat = 1; beat * 0.1 < settings_.silence_s + 0.2; ++beat) {
    write(standby, Name::master_heartbeat, {beat});
    pass(0.1);
  }
  EXPECT_EQ(sent(),
            std::vector<std::string>{"stop"});  // the heartbeat of the standby does not hide the silence
  EXPECT_EQ(read(standby, Name::master), 2);
  accept();
  EXPECT_EQ(read(standby, Name::master), 1);
  EXPECT_EQ(read(Name::master), 2);
  put(standby, 1, CommandCode::start);  // the standby replaces the silent master
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

TEST_F(GatewayTest, RepeatsTheStopUntilADaemonConfirmsTheStop) {
  daemon_comes();
  write(Name::master_heartbeat, 5);
  gateway_.on_daemon_disconnected();  // the daemon and the master become silent at the same time
  pass(settings_.silence_s + 0.1);
  EXPECT_TRUE(sent().empty());
  daemon_comes_and_gets_the_stop();
  pass(0.1);
  EXPECT_TRUE(sent().empty());
  gateway_.on_daemon_disconnected();  // the connection ends before the daemon has responded to the stop
  pass(1);
  daemon_comes_and_gets_the_stop();
  refuse({{"code", "busy"}});
  pass(0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
  refuse({{"code", "refused"}, {"refusal", {{"code", "R07"}}}});  // the refusal "nothing to stop" also
                                                                  // confirms the stop
  pass(1);
  EXPECT_TRUE(sent().empty());
  EXPECT_FALSE(gateway_.heartbeat_monitor().stop_required());
}

TEST_F(GatewayTest, AReplyToAnEarlierStopDoesNotConfirmALaterStop) {
  daemon_comes();
  write(Name::master_heartbeat, 5);
  pass(settings_.silence_s + 0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
  write(Name::master_heartbeat, 6);
  pass(settings_.silence_s + 0.1);
  EXPECT_TRUE(sent().empty());  // the gateway sends no second stop while the response to the first one is
                                // missing
  accept();
  EXPECT_TRUE(gateway_.heartbeat_monitor().stop_required());
  pass(0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
  accept();
  EXPECT_FALSE(gateway_.heartbeat_monitor().stop_required());
}

TEST_F(GatewayTest, RepeatsAReleaseThatAStartingDaemonRefuses) {
  settings_.when_silent = Reaction::release;
  daemon_comes();
  write(Name::master_heartbeat, 5);
  pass(settings_.silence_s + 0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"release"});
  refuse({{"code", "refused"}, {"refusal", {{"code", "R06"}}}});
  pass(0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"release"});
  refuse({{"code", "refused"}, {"refusal", {{"code", "R11"}}}});
  pass(0.1);
  EXPECT_TRUE(sent().empty());
}

TEST_F(GatewayTest, SendsAReleaseAfterTheNameOfTheClient) {
  settings_.when_silent = Reaction::release;
  daemon_comes();
  write(Name::master_heartbeat, 5);
  gateway_.on_daemon_disconnected();
  pass(settings_.silence_s + 0.1);
  daemon_comes();
  pass(0.1);
  EXPECT_EQ(sent(), std::vector<std::string>{"release"});
}

TEST_F(GatewayTest, ATimeOutWithoutAReactionSendsNoCommand) {
  settings_.when_silent = Reaction::nothing;
  daemon_comes();
  write(Name::master_heartbeat, 5);
  pass(settings_.silence_s + 0.1);
  EXPECT_TRUE(sent().empty());
  write(Name::master_heartbeat, 6);
  EXPECT_EQ(read(Name::master), 1);
}

TEST_F(GatewayTest, SendsAVentButNoStartToAPausedDaemon) {
  daemon_comes();
  put(plc_, 0, CommandCode::none);
  put(plc_, 1, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
  pass(1.1, false);
  EXPECT_EQ(read(Name::state), 0);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::unknown, Reason::no_daemon));
  put(plc_, 2, CommandCode::start);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::no_daemon));
  put(plc_, 3, CommandCode::vent);
  EXPECT_EQ(sent(), std::vector<std::string>{"vent"});
  pass(0.1, false);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::unknown, Reason::no_daemon));
  pass(0.1);
  EXPECT_EQ(read(Name::state), 2);
  put(plc_, 4, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

TEST_F(GatewayTest, LimitsTheCommandsSentToADaemonThatDoesNotReply) {
  daemon_comes();
  put(plc_, 0, CommandCode::none);
  std::size_t lines = 0;
  for (std::uint16_t counter = 1; counter < 1000; ++counter) {
    put(plc_, counter, CommandCode::vent);
    lines += sent().size();
    pass(0.02, false);
  }
  EXPECT_GT(lines, 10U);
  EXPECT_LT(lines, 100U);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::refused, Reason::no_daemon));
}

TEST_F(GatewayTest, AQueuedCommandIsSentAfterTheExecutingOne) {
  daemon_comes();
  put(plc_, 0, CommandCode::none);
  put(plc_, 1, CommandCode::release);
  put(plc_, 2, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"release"});
  accept();
  gateway_.update(now_);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
}

/// The control loop may still execute the command. The gateway must therefore report the outcome as unknown,
/// not as refused.
TEST_F(GatewayTest, ACommandThatTheLoopDidNotConfirmIsUnknown) {
  daemon_comes();
  put(plc_, 0, CommandCode::none);
  put(plc_, 1, CommandCode::start);
  EXPECT_EQ(sent(), std::vector<std::string>{"start"});
  refuse({{"code", "no_answer"}, {"message", ""}});
  EXPECT_EQ(read(Name::done_counter), 1);
  EXPECT_EQ(end_of(plc_), std::pair(Outcome::unknown, Reason::no_answer));
  put(plc_, 2, CommandCode::stop);
  EXPECT_EQ(sent(), std::vector<std::string>{"stop"});
}

TEST_F(GatewayTest, EveryAcceptedReplyIsProcessedWithoutException) {
  daemon_comes();
  for (const Json& good : tools::testing::good_lines()) {
    for (const Json& bad : tools::testing::damaged(good)) {
      const auto parsed = tools::parse_reply(bad.dump());
      if (parsed) {
        EXPECT_NO_THROW(gateway_.on_daemon_line(*parsed, now_)) << bad;
      }
    }
  }
}

TEST(Server, ReturnsTheAddressOfTheClient) {
  const auto listener = net::listen_tcp("127.0.0.1", 0);
  ASSERT_TRUE(listener);
  Descriptor client(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ASSERT_EQ(::getsockname(listener->socket.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  ASSERT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
  const Descriptor accepted = net::accept_client(listener->socket);
  ASSERT_TRUE(accepted);
  EXPECT_EQ(address_of(accepted.get()), "127.0.0.1");
  EXPECT_EQ(address_of(-1), "");
}

}  // namespace
}  // namespace softgrip::plc::gateway_test
