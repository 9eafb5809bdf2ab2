// Tests a session with a server whose responses are late, incomplete, wrong or missing, and whose connections
// fail.

#include "drivers/modbus/modbus_tcp_link.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <random>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "drivers/modbus/modbus_message.h"
#include "tests/drivers/modbus/scripted_server.h"

namespace softgrip::drivers::modbus_tcp_link_test {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::Peer;
using test::ScriptedServer;

// Largest time by which a correct call exceeds its deadline on a computer under load. A call that waits for a
// late or slow response would exceed the deadline by much more, so the test would fail.
constexpr Nanoseconds slack = 400'000'000;
constexpr Nanoseconds deadline = 50'000'000;
constexpr Nanoseconds generous = 5'000'000'000;

constexpr ModbusRequest read_four{.function = 3, .address = 100, .count = 4};

Nanoseconds now() {
  return MonotonicClock().now();
}

std::uint16_t register_value(std::uint16_t address) {
  return static_cast<std::uint16_t>(address * 7 + 3);
}

void answer_well(Peer& peer, const Bytes& request) {
  peer.send(test::registers_reply(request, register_value));
}

/// Returns success if the session has received the contents of the registers that `request` reads.
testing::AssertionResult is_answer(const ModbusTcpLink& session, const ModbusRequest& request) {
  if (session.data().size() != 2U * request.count) {
    return testing::AssertionFailure() << session.data().size() << " bytes for " << request.count;
  }
  for (std::uint16_t i = 0; i < request.count; ++i) {
    const auto expected = register_value(static_cast<std::uint16_t>(request.address + i));
    const auto got = word_at(session.data(), 2U * i);
    if (got != expected) {
      return testing::AssertionFailure()
             << "register " << request.address + i << " is " << got << ", not " << expected;
    }
  }
  return testing::AssertionSuccess();
}

struct Outcome {
  BusStatus status;
  bool open_after;
  Nanoseconds took;
  std::string detail;
};

/// Sends one request. `misbehave` sends the first response of the server; all later responses are correct.
/// Then checks that the next request reads the correct values; for this, opens a new session if the first
/// request has ended the session. Returns the outcome of the first request.
Outcome ask_once(const std::function<void(Peer&, const Bytes&)>& misbehave,
                 const ModbusRequest& request = read_four, Nanoseconds within = deadline) {
  ScriptedServer server([&](Peer& peer, const Bytes& asked, std::size_t index) {
    if (index == 0) {
      misbehave(peer, asked);
    } else {
      answer_well(peer, asked);
    }
  });
  ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
  EXPECT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
  const Nanoseconds before = now();
  Outcome outcome{};
  outcome.status = session.ask(1, request, before + within);
  outcome.took = now() - before;
  outcome.open_after = session.is_open();
  outcome.detail = session.detail();
  if (!session.is_open()) {
    EXPECT_EQ(session.ask(1, read_four, now() + generous), BusStatus::disconnected)
        << "a session must not be used after a defective response";
    EXPECT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
  }
  EXPECT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok) << session.detail();
  EXPECT_TRUE(is_answer(session, read_four));
  return outcome;
}

/// Calls ask_once() with a response that is correct except for the change that `spoil` makes.
Outcome ask_spoiled(const std::function<void(Bytes&)>& spoil) {
  return ask_once([&](Peer& peer, const Bytes& request) {
    Bytes reply = test::registers_reply(request, register_value);
    spoil(reply);
    peer.send(reply);
  });
}

void expect_poisoned(const Outcome& outcome, BusStatus status, Nanoseconds at_most) {
  EXPECT_EQ(name_of(outcome.status), std::string(name_of(status))) << outcome.detail;
  EXPECT_FALSE(outcome.open_after);
  EXPECT_LT(outcome.took, at_most);
  EXPECT_FALSE(outcome.detail.empty());
}

TEST(ModbusTcpLink, ReadsRegisters) {
  const Outcome outcome = ask_once(answer_well, read_four, generous);
  EXPECT_EQ(outcome.status, BusStatus::ok) << outcome.detail;
  EXPECT_TRUE(outcome.open_after);
}

TEST(ModbusTcpLink, ALateResponseTimesOutAndIsNotUsedForALaterRequest) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes& request) {
    peer.wait(750ms);
    answer_well(peer, request);
  });
  expect_poisoned(outcome, BusStatus::timed_out, deadline + slack);
  EXPECT_GE(outcome.took, deadline);
}

TEST(ModbusTcpLink, ASlowResponseDoesNotExtendTheDeadline) {
  const ModbusRequest large{.function = 3, .address = 0, .count = 125};
  const Outcome outcome = ask_once(
      [](Peer& peer, const Bytes& request) {
        peer.drip(test::registers_reply(request, register_value), 10ms);  // all bytes of the response take
                                                                          // 2.6 s, which exceeds the deadline
      },
      large);
  expect_poisoned(outcome, BusStatus::timed_out, deadline + slack);
}

TEST(ModbusTcpLink, AcceptsAResponseInPiecesWithinTheDeadline) {
  const Outcome outcome =
      ask_once([](Peer& peer,
                  const Bytes& request) { peer.drip(test::registers_reply(request, register_value), 1ms); },
               read_four, generous);
  EXPECT_EQ(outcome.status, BusStatus::ok) << outcome.detail;
}

TEST(ModbusTcpLink, RefusesAResponseWithAWrongUnitId) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply[6] = 2; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesAResponseWithAWrongTransactionId) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply[1] ^= 1; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesAResponseWithAWrongProtocolId) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply[3] = 1; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesALengthThatIsTooLarge) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { ++reply[5]; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesALengthThatIsTooSmall) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { --reply[5]; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesTheLengthOfAnExceptionInARegularResponse) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply[5] = 3; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesFewerRegistersThanRequested) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes& request) {
    peer.send(test::frame_for(request, {3, 2, 0, 1}));
  });
  expect_poisoned(outcome, BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesAByteCountThatContradictsTheLength) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply[8] = 6; }), BusStatus::bad_reply, slack);
}

// Like libmodbus, the session waits for the number of bytes that the response announces. At the deadline, it
// evaluates the bytes that have arrived.
TEST(ModbusTcpLink, RefusesAByteCountAboveTheReceivedBytes) {
  const Outcome outcome = ask_spoiled([](Bytes& reply) { reply[8] = 200; });
  expect_poisoned(outcome, BusStatus::bad_reply, deadline + slack);
  EXPECT_NE(outcome.detail.find("byte count"), std::string::npos) << outcome.detail;
}

TEST(ModbusTcpLink, RefusesAResponseOfAnotherFunction) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply[7] = 4; }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, ShortReplyTimesOut) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply.pop_back(); }), BusStatus::timed_out,
                  deadline + slack);
}

TEST(ModbusTcpLink, RefusesTrailingBytes) {
  expect_poisoned(ask_spoiled([](Bytes& reply) { reply.push_back(0); }), BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesOneMillionArbitraryBytes) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes&) {
    peer.send(Bytes(1'000'000, 0x5a));
    peer.hang_up();
  });
  expect_poisoned(outcome, BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesManyBytesAfterACorrectResponse) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes& request) {
    Bytes reply = test::registers_reply(request, register_value);
    reply.resize(500'000, 0);
    peer.send(reply);
    peer.hang_up();
  });
  expect_poisoned(outcome, BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, AMissingResponseTimesOut) {
  const Outcome outcome = ask_once([](Peer&, const Bytes&) {});
  expect_poisoned(outcome, BusStatus::timed_out, deadline + slack);
  EXPECT_GE(outcome.took, deadline);
}

TEST(ModbusTcpLink, ReportsAConnectionClosedBeforeTheResponse) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes&) { peer.hang_up(); });
  expect_poisoned(outcome, BusStatus::closed_at_once, slack);
  EXPECT_NE(outcome.detail.find("closed it before the first response"), std::string::npos) << outcome.detail;
}

TEST(ModbusTcpLink, ReportsAConnectionClosedDuringTheResponse) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes& request) {
    Bytes reply = test::registers_reply(request, register_value);
    reply.resize(reply.size() / 2);
    peer.send(reply);
    peer.hang_up();
  });
  expect_poisoned(outcome, BusStatus::closed_at_once, slack);
}

TEST(ModbusTcpLink, ReportsAConnectionResetByTheServer) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes&) { peer.reset(); });
  expect_poisoned(outcome, BusStatus::closed_at_once, slack);
}

TEST(ModbusTcpLink, DistinguishesAnImmediateCloseFromALaterDisconnection) {
  ScriptedServer server([](Peer& peer, const Bytes& request, std::size_t index) {
    if (index == 0) {
      answer_well(peer, request);
    } else {
      peer.hang_up();
    }
  });
  ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  ASSERT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok);
  EXPECT_EQ(session.ask(1, read_four, now() + generous), BusStatus::disconnected);
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  EXPECT_EQ(session.ask(1, read_four, now() + generous), BusStatus::closed_at_once)
      << "the server closes the new connection";
}

/// Returns a listening socket on a free port of this machine.
int listening(int backlog, std::uint16_t& port) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::listen(listener, backlog), 0);
  EXPECT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  port = ntohs(address.sin_port);
  return listener;
}

/// A server that accepts a connection and sends `greeting`. If `closes` is true, it then closes the
/// connection.
class Greeter {
 public:
  Greeter(const std::string& greeting, bool closes) {
    listener_ = listening(4, port);
    thread_ = std::thread([this, greeting, closes] {
      socket_ = ::accept(listener_, nullptr, nullptr);
      if (socket_ < 0) return;
      EXPECT_EQ(::send(socket_, greeting.data(), greeting.size(), MSG_NOSIGNAL),
                static_cast<ssize_t>(greeting.size()));
      if (closes) ::close(std::exchange(socket_, -1));
    });
  }
  Greeter(const Greeter&) = delete;
  Greeter& operator=(const Greeter&) = delete;
  Greeter(Greeter&&) = delete;
  Greeter& operator=(Greeter&&) = delete;
  ~Greeter() {
    thread_.join();
    if (socket_ >= 0) ::close(socket_);
    ::close(listener_);
  }
  std::uint16_t port = 0;

 private:
  int listener_ = -1;
  int socket_ = -1;
  std::thread thread_;
};

TcpAddress settling(std::uint16_t port, double settle_s) {
  return {.host = "127.0.0.1", .port = port, .habits = {.settle_s = settle_s}};
}

TEST(ModbusTcpLink, SendsNothingBeforeTheSettlingTimeEnds) {
  std::atomic<Nanoseconds> first_request{0};
  ScriptedServer server([&](Peer& peer, const Bytes& request, std::size_t index) {
    if (index == 0) first_request = now();
    answer_well(peer, request);
  });
  ModbusTcpLink session(settling(server.port(), 0.2));
  const Nanoseconds before = now();
  ASSERT_EQ(session.open(before + generous), BusStatus::ok);
  ASSERT_EQ(session.settle(before + generous), BusStatus::ok) << session.detail();
  ASSERT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok) << session.detail();
  EXPECT_GE(first_request - before, 200'000'000);
  EXPECT_EQ(session.settle(now() - 1), BusStatus::ok) << "the wait occurs once per session";
}

TEST(ModbusTcpLink, ASettleTimeDoesNotExtendTheDeadline) {
  ScriptedServer server([](Peer&, const Bytes&, std::size_t) {});
  ModbusTcpLink session(settling(server.port(), 30));
  const Nanoseconds before = now();
  ASSERT_EQ(session.open(before + generous), BusStatus::ok);
  EXPECT_EQ(session.settle(before + deadline), BusStatus::timed_out);
  EXPECT_LT(now() - before, deadline + slack);
  EXPECT_FALSE(session.is_open());
}

TEST(ModbusTcpLink, DetectsAConnectionClosedDuringTheSettlingTime) {
  const Greeter server("", true);
  ModbusTcpLink session(settling(server.port, 30));
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  const Nanoseconds before = now();
  EXPECT_EQ(session.settle(before + generous), BusStatus::closed_at_once);
  EXPECT_LT(now() - before, generous / 2);
}

TEST(ModbusTcpLink, DiscardsBytesReceivedDuringTheSettlingTime) {
  const Greeter server("ready\r\n", false);
  ModbusTcpLink session(settling(server.port, 0.2));
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  ASSERT_EQ(session.settle(now() + generous), BusStatus::ok) << session.detail();
  EXPECT_EQ(session.ask(1, read_four, now() + deadline), BusStatus::timed_out) << session.detail();
}

TEST(ModbusTcpLink, ARequestAfterItsDeadlineIsNotSent) {
  std::atomic<int> requests = 0;
  ScriptedServer server([&](Peer& peer, const Bytes& request, std::size_t) {
    ++requests;
    answer_well(peer, request);
  });
  ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
  EXPECT_EQ(session.ask(1, read_four, now() - 1), BusStatus::timed_out);
  EXPECT_NE(std::string(session.detail()).find("before sending the request"), std::string::npos)
      << session.detail();
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
  EXPECT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok) << session.detail();
  EXPECT_EQ(requests, 1);
}

TEST(ModbusTcpLink, ExceptionsKeepTheSession) {
  for (const int code : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0x55, 255}) {
    const Outcome outcome = ask_once(
        [code](Peer& peer, const Bytes& request) {
          peer.send(test::exception_reply(request, static_cast<std::uint8_t>(code)));
        },
        read_four, generous);
    EXPECT_EQ(outcome.status, BusStatus::exception) << code;
    EXPECT_TRUE(outcome.open_after) << code;
    EXPECT_NE(outcome.detail.find("(exception " + std::to_string(code) + ")"), std::string::npos)
        << outcome.detail;
  }
}

TEST(ModbusTcpLink, RefusesAnExceptionOfAnotherFunction) {
  const Outcome outcome = ask_once([](Peer& peer, const Bytes& request) {
    peer.send(test::frame_for(request, {0x90, 2}));
  });
  expect_poisoned(outcome, BusStatus::bad_reply, slack);
}

TEST(ModbusTcpLink, RefusesAWriteConfirmationForAnotherAddress) {
  const std::uint16_t value = 77;
  const Outcome outcome = ask_once(
      [](Peer& peer, const Bytes& request) {
        peer.send(test::frame_for(request, {6, 0, 11, 0, 77}));
      },
      {.function = 6, .address = 10, .values = {&value, 1}});
  expect_poisoned(outcome, BusStatus::bad_reply, slack);
}

// If a server sends one response twice, a careless client assigns every later response to the wrong request.
// This server sends some responses twice, at random. The copy follows immediately or later. Each request
// reads different registers, so the test detects a wrong assignment.
TEST(ModbusTcpLink, DuplicateResponsesAreNeverAssignedToOtherRequests) {
  const unsigned seed = 20250411;
  std::mt19937 random(seed);
  ScriptedServer server([&random](Peer& peer, const Bytes& request, std::size_t) {
    const Bytes reply = test::registers_reply(request, register_value);
    peer.send(reply);
    const unsigned chance = random() % 4;
    if (chance == 0) peer.send(reply);
    if (chance == 1) {
      peer.wait(1ms);
      peer.send(reply);
    }
  });
  ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
  std::size_t good = 0;
  std::size_t bad = 0;
  for (std::uint16_t i = 0; i < 300; ++i) {
    if (!session.is_open()) {
      ASSERT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
    }
    const ModbusRequest request{.function = 4, .address = static_cast<std::uint16_t>(i * 3), .count = 2};
    const BusStatus status = session.ask(1, request, now() + generous);
    if (status == BusStatus::ok) {
      ++good;
      ASSERT_TRUE(is_answer(session, request)) << "request " << i << ", seed " << seed;
    } else {
      ++bad;
      ASSERT_EQ(status, BusStatus::bad_reply) << session.detail() << ", seed " << seed;
    }
  }
  EXPECT_GT(good, 100U);
  EXPECT_GT(bad, 50U) << "too few duplicates reached the client for a valid test";
}

TEST(ModbusTcpLink, ReportsARefusedConnection) {
  std::uint16_t port = 0;
  {
    port = ScriptedServer([](Peer&, const Bytes&, std::size_t) {}).port();
  }
  ModbusTcpLink session(TcpAddress{"127.0.0.1", port});
  const Nanoseconds before = now();
  EXPECT_EQ(session.open(before + generous), BusStatus::disconnected);
  EXPECT_LT(now() - before, slack);
  EXPECT_NE(std::string(session.detail()).find("refused"), std::string::npos) << session.detail();
}

TEST(ModbusTcpLink, NamesAreNotResolved) {
  ModbusTcpLink session(TcpAddress{"localhost", 502});
  EXPECT_EQ(session.open(now() + generous), BusStatus::disconnected);
  EXPECT_NE(std::string(session.detail()).find("numeric"), std::string::npos) << session.detail();
}

// The queue of this listener is full. The kernel then drops the first packet of every new connection, so the
// attempt to connect must time out.
TEST(ModbusTcpLink, ConnectingTimesOutIfTheServerDoesNotRespond) {
  std::uint16_t port = 0;
  const int listener = listening(0, port);
  std::vector<std::unique_ptr<ModbusTcpLink>> queue;
  BusStatus status = BusStatus::ok;
  Nanoseconds took = 0;
  for (int i = 0; i < 8 && status == BusStatus::ok; ++i) {
    queue.push_back(std::make_unique<ModbusTcpLink>(TcpAddress{"127.0.0.1", port}));
    const Nanoseconds before = now();
    status = queue.back()->open(before + deadline);
    took = now() - before;
  }
  EXPECT_EQ(status, BusStatus::timed_out);
  EXPECT_GE(took, deadline);
  EXPECT_LT(took, deadline + slack);
  ::close(listener);
}

TEST(ModbusTcpLink, AHalfOpenSessionTimesOut) {
  ScriptedServer server([](Peer& peer, const Bytes& request, std::size_t index) {
    if (index == 0)
      answer_well(peer, request);  // the server keeps the connection open but does not respond to later
                                   // requests
  });
  ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  ASSERT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok);
  const Nanoseconds before = now();
  EXPECT_EQ(session.ask(1, read_four, before + deadline), BusStatus::timed_out);
  EXPECT_LT(now() - before, deadline + slack);
  EXPECT_EQ(session.ask(1, read_four, now() + deadline), BusStatus::disconnected);
}

TcpAddress repeating(std::uint16_t port, bool numbered = true) {
  return {.host = "127.0.0.1", .port = port, .habits = {.repeat_after_s = 0.05}, .numbered = numbered};
}

// The link may send a request a second time if the response is missing. The second frame must be identical,
// so that it writes the same output values.
TEST(ModbusTcpLink, RepeatsALostRequestInTheSameSession) {
  std::vector<Bytes> asked;
  ScriptedServer server([&](Peer& peer, const Bytes& request, std::size_t index) {
    asked.push_back(request);
    if (index > 0) answer_well(peer, request);
  });
  ModbusTcpLink session(repeating(server.port()));
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  ASSERT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok) << session.detail();
  EXPECT_TRUE(is_answer(session, read_four));
  ASSERT_GE(asked.size(), 2U);
  EXPECT_EQ(asked[0], asked[1]);
  EXPECT_EQ(server.sessions(), 1U);
}

// The next session writes the safe outputs. The repetition of a request must therefore not delay the next
// session.
TEST(ModbusTcpLink, RepeatingDoesNotExtendTheDeadline) {
  std::atomic<std::size_t> asked{0};
  ScriptedServer server([&](Peer&, const Bytes&, std::size_t) { ++asked; });
  ModbusTcpLink session(repeating(server.port()));
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  const Nanoseconds before = now();
  EXPECT_EQ(session.ask(1, read_four, before + 220'000'000), BusStatus::timed_out);
  EXPECT_LT(now() - before, 220'000'000 + slack);
  EXPECT_FALSE(session.is_open());
  EXPECT_GE(asked, 2U);
}

/// Simulates a board whose first response is late. After this delay, the board responds to the request and to
/// each repetition of the request.
void answer_late_once(Peer& peer, const Bytes& request, std::size_t index, bool numbered) {
  if (index == 0) peer.wait(130ms);
  Bytes reply = test::registers_reply(request, register_value);
  if (!numbered) test::set_word(reply, 0, 0);
  peer.send(reply);
}

TEST(ModbusTcpLink, ASecondResponseIsNotUsedForALaterRequest) {
  for (const bool numbered : {true, false}) {
    ScriptedServer server([numbered](Peer& peer, const Bytes& request, std::size_t index) {
      answer_late_once(peer, request, index, numbered);
    });
    ModbusTcpLink session(repeating(server.port(), numbered));
    ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
    for (std::uint16_t i = 0; i < 4; ++i) {
      const ModbusRequest request{.function = 3, .address = static_cast<std::uint16_t>(i * 50), .count = 4};
      ASSERT_EQ(session.ask(1, request, now() + generous), BusStatus::ok) << i << ": " << session.detail();
      ASSERT_TRUE(is_answer(session, request)) << i;
    }
    EXPECT_EQ(server.sessions(), 1U);
  }
}

TEST(ModbusTcpLink, AcceptsAMissingTransactionIdOnlyIfConfigured) {
  ScriptedServer server([](Peer& peer, const Bytes& request, std::size_t index) {
    Bytes reply = test::registers_reply(request, register_value);
    test::set_word(reply, 0, 0);
    peer.send(reply);
    if (index != 3) return;
    peer.wait(30ms);
    peer.send(reply);
  });
  ModbusTcpLink strict(TcpAddress{"127.0.0.1", server.port()});
  ASSERT_EQ(strict.open(now() + generous), BusStatus::ok);
  EXPECT_EQ(strict.ask(1, read_four, now() + generous), BusStatus::bad_reply);
  strict.close();
  ModbusTcpLink lenient(TcpAddress{.host = "127.0.0.1", .port = server.port(), .numbered = false});
  ASSERT_EQ(lenient.open(now() + generous), BusStatus::ok);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(lenient.ask(1, read_four, now() + generous), BusStatus::ok) << lenient.detail();
    EXPECT_TRUE(is_answer(lenient, read_four));
  }
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(lenient.ask(1, read_four, now() + generous), BusStatus::bad_reply)
      << "a second response to the request has arrived";
  EXPECT_NE(std::string(lenient.detail()).find("unexpected"), std::string::npos) << lenient.detail();
}

TEST(ModbusTcpLink, ADeadlineInThePastFailsAtOnce) {
  ScriptedServer server([](Peer&, const Bytes&, std::size_t) {});
  ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
  ASSERT_EQ(session.open(now() + generous), BusStatus::ok);
  EXPECT_EQ(session.ask(1, read_four, now() - 1), BusStatus::timed_out);
}

// The test opens files until new descriptors have numbers above 1024. Such a descriptor does not fit into the
// fd_set with which libmodbus waits. A link that was created earlier must use its lower descriptor in all
// later sessions.
TEST(ModbusTcpLink, OnlyLinksCreatedBelowDescriptor1024CanConnect) {
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit before = limit;
  limit.rlim_cur = std::min<rlim_t>(2048, limit.rlim_max);
  ASSERT_GE(limit.rlim_cur, 1200U);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  {
    ScriptedServer server([](Peer& peer, const Bytes& request, std::size_t) { answer_well(peer, request); });
    ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
    std::vector<int> taken;
    while (taken.empty() || taken.back() < 1100) {
      taken.push_back(::open("/dev/null", O_RDONLY | O_CLOEXEC));
      ASSERT_GE(taken.back(), 0);
    }
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
      EXPECT_EQ(session.ask(1, read_four, now() + generous), BusStatus::ok) << session.detail();
      EXPECT_TRUE(is_answer(session, read_four));
    }
    ModbusTcpLink late(TcpAddress{"127.0.0.1", server.port()});
    EXPECT_EQ(late.open(now() + generous), BusStatus::disconnected);
    EXPECT_NE(std::string(late.detail()).find("below 1024"), std::string::npos) << late.detail();
    for (const int descriptor : taken) ::close(descriptor);
  }
  ::setrlimit(RLIMIT_NOFILE, &before);
}

// A timer interrupts every wait of the link. An interrupted wait must end neither too early nor too late.
TEST(ModbusTcpLink, SignalsDoNotMoveTheDeadline) {
  struct sigaction handler {};
  struct sigaction old {};
  handler.sa_handler = [](int) {};
  ::sigaction(SIGALRM, &handler, &old);
  const itimerval every{{0, 2000}, {0, 2000}};
  const itimerval never{};
  {
    ScriptedServer server([](Peer&, const Bytes&, std::size_t) {});
    ModbusTcpLink session(TcpAddress{"127.0.0.1", server.port()});
    ASSERT_EQ(session.open(now() + generous), BusStatus::ok) << session.detail();
    ::setitimer(ITIMER_REAL, &every, nullptr);
    const Nanoseconds before = now();
    EXPECT_EQ(session.ask(1, read_four, before + deadline), BusStatus::timed_out) << session.detail();
    const Nanoseconds took = now() - before;
    ::setitimer(ITIMER_REAL, &never, nullptr);
    EXPECT_GE(took, deadline);
    EXPECT_LT(took, deadline + slack);
  }
  ::sigaction(SIGALRM, &old, nullptr);
}

}  // namespace
}  // namespace softgrip::drivers::modbus_tcp_link_test
