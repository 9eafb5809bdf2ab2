// Tests the serial link with a module whose responses are late, incomplete, corrupted or missing. After a
// faulty response, the link must read the correct values again.

#include "drivers/modbus/modbus_rtu_link.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "base/clock.h"
#include "drivers/modbus/modbus_message.h"
#include "drivers/modbus/serial_port.h"
#include "tests/drivers/modbus/scripted_line.h"

namespace softgrip::drivers::modbus_rtu_link_test {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::checked;
using test::ScriptedLine;

// Largest time by which a correct call exceeds its deadline on a computer under load. A call that waits for a
// late or slow response would exceed the deadline by much more.
constexpr Nanoseconds slack = 400'000'000;
constexpr Nanoseconds deadline = 100'000'000;
constexpr Nanoseconds generous = 10'000'000'000;
constexpr ModbusRequest read_two{.function = 4, .address = 3, .count = 2};

Nanoseconds now() {
  return MonotonicClock().now();
}

SerialLine line_at(const std::string& device, std::uint32_t baud = 115200) {
  SerialLine line;
  line.device = device;
  line.baud = baud;
  return line;
}

/// Returns a line at 9600 baud. After a fault, the next session first listens for the duration of the longest
/// frame, which is 0.27 s at 9600 baud. This time is much longer than the delay of a byte on a computer under
/// load. At 115200 baud, the duration would be only 22 ms, which is too short.
SerialLine listening_long() {
  return line_at("", 9600);
}

/// Returns a response in which input register N contains 1000 + N.
Bytes good_reply(const Bytes& request) {
  const std::size_t first = request[3];
  const std::size_t count = request[5];
  Bytes reply{request[0], request[1], static_cast<std::uint8_t>(2 * count)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t value = 1000 + first + i;
    reply.push_back(static_cast<std::uint8_t>(value >> 8));
    reply.push_back(static_cast<std::uint8_t>(value & 0xff));
  }
  return checked(reply);
}

bool right(const ModbusRtuLink& link) {
  return link.data().size() == 4 && word_at(link.data(), 0) == 1003 && word_at(link.data(), 2) == 1004;
}

struct Outcome {
  BusStatus status;
  bool open_after;
  Nanoseconds took;
  std::string detail;
};

/// Sends one request, to which `misbehave` responds. Then checks that the next request reads the correct
/// values; for this, opens a new session if the first request has ended the session. Returns the outcome of
/// the first request.
Outcome ask_once(const std::function<void(ScriptedLine&, const Bytes&)>& misbehave,
                 SerialLine settings = line_at("")) {
  ScriptedLine line([&](ScriptedLine& self, const Bytes& request, std::size_t index) {
    if (index == 0) {
      misbehave(self, request);
    } else {
      if (settings.echo) self.send(request);
      self.send(good_reply(request));
    }
  });
  settings.device = line.device();
  ModbusRtuLink link(settings);
  EXPECT_EQ(link.open(now() + generous), BusStatus::ok) << link.detail();
  const Nanoseconds before = now();
  Outcome outcome{};
  outcome.status = link.ask(1, read_two, before + deadline);
  outcome.took = now() - before;
  outcome.open_after = link.is_open();
  outcome.detail = link.detail();
  if (outcome.status == BusStatus::ok) {
    EXPECT_TRUE(right(link));
  }
  if (!outcome.open_after) {
    EXPECT_EQ(link.ask(1, read_two, now() + generous), BusStatus::disconnected);
    EXPECT_EQ(link.open(now() + generous), BusStatus::ok) << link.detail();
  }
  EXPECT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok) << link.detail();
  EXPECT_TRUE(right(link));
  return outcome;
}

void expect_end(const Outcome& outcome, BusStatus status, const std::string& why) {
  EXPECT_EQ(outcome.status, status) << outcome.detail;
  EXPECT_FALSE(outcome.open_after);
  EXPECT_LT(outcome.took, deadline + slack);
  EXPECT_NE(outcome.detail.find(why), std::string::npos) << outcome.detail;
}

TEST(ModbusRtuLink, ReadsRegisters) {
  const Outcome outcome = ask_once([](ScriptedLine& line, const Bytes& request) {
    EXPECT_EQ(request, checked({1, 4, 0, 3, 0, 2}));
    line.send(good_reply(request));
  });
  EXPECT_EQ(outcome.status, BusStatus::ok) << outcome.detail;
  EXPECT_TRUE(outcome.open_after);
}

TEST(ModbusRtuLink, AMissingResponseTimesOut) {
  expect_end(ask_once([](ScriptedLine&, const Bytes&) {}), BusStatus::timed_out, "waiting for the reply");
}

TEST(ModbusRtuLink, ASlowResponseDoesNotExtendTheDeadline) {
  expect_end(ask_once(
                 [](ScriptedLine& line, const Bytes& request) {
                   Bytes reply = good_reply(request);
                   reply.resize(3);  // the module sends 3 bytes; the last byte arrives after the deadline,
                                     // while the next session listens
                   line.drip(reply, 55ms);
                 },
                 listening_long()),
             BusStatus::timed_out, "rest of the reply");
}

TEST(ModbusRtuLink, AcceptsAResponseInPiecesWithinTheDeadline) {
  const Outcome outcome =
      ask_once([](ScriptedLine& line, const Bytes& request) { line.drip(good_reply(request), 2ms); });
  EXPECT_EQ(outcome.status, BusStatus::ok) << outcome.detail;
}

TEST(ModbusRtuLink, ALateResponseIsNotUsedForALaterRequest) {
  expect_end(ask_once(
                 [](ScriptedLine& line, const Bytes& request) {
                   line.wait(110ms);
                   Bytes late = good_reply(request);
                   late[4] = 9;  // change the data, so that the test can distinguish this response from the
                                 // correct one
                   late.resize(late.size() - 2);
                   line.send(checked(late));
                 },
                 listening_long()),
             BusStatus::timed_out, "waiting for the reply");
}

TEST(ModbusRtuLink, ADuplicateResponseEndsTheSessionAtTheNextRequest) {
  ScriptedLine line([&](ScriptedLine& self, const Bytes& request, std::size_t index) {
    self.send(good_reply(request));
    if (index == 0) {
      self.wait(20ms);
      self.send(good_reply(request));
    }
  });
  ModbusRtuLink link(line_at(line.device()));
  ASSERT_EQ(link.open(now() + generous), BusStatus::ok);
  ASSERT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok);
  ScriptedLine::wait(60ms);
  EXPECT_EQ(link.ask(1, {.function = 4, .address = 9, .count = 2}, now() + generous), BusStatus::bad_reply);
  EXPECT_NE(std::string(link.detail()).find("unexpected bytes"), std::string::npos) << link.detail();
  EXPECT_FALSE(link.is_open());
}

TEST(ModbusRtuLink, RefusesResponsesThatDoNotMatchTheRequest) {
  const auto changed = [](std::size_t at, std::uint8_t value) {
    return [at, value](ScriptedLine& line, const Bytes& request) {
      Bytes reply = good_reply(request);
      reply.resize(reply.size() - 2);
      reply[at] = value;
      line.send(checked(reply));
    };
  };
  expect_end(ask_once(changed(0, 2)), BusStatus::bad_reply, "a wrong unit id");
  expect_end(ask_once(changed(1, 3)), BusStatus::bad_reply, "a different function code");
  expect_end(ask_once(changed(2, 6)), BusStatus::bad_reply, "byte count");
  expect_end(ask_once([](ScriptedLine& line, const Bytes& request) {
               Bytes reply = good_reply(request);
               reply[3] = static_cast<std::uint8_t>(reply[3] ^ 0x10U);
               line.send(reply);
             }),
             BusStatus::bad_reply, "checksum");
  expect_end(ask_once([](ScriptedLine& line, const Bytes& request) {
               Bytes reply = good_reply(request);
               reply.resize(reply.size() + 5);  // add 5 bytes, which could be a second response, because the
                                                // shortest response has 5 bytes
               line.send(reply);
             }),
             BusStatus::bad_reply, "additional bytes");
  expect_end(ask_once([](ScriptedLine& line, const Bytes& request) { line.send(request); }),
             BusStatus::bad_reply, "returns the sent bytes");
}

// The shortest response has 5 bytes. Fewer than 5 additional bytes cannot be a response, so the link must
// ignore these bytes as noise.
TEST(ModbusRtuLink, StrayBytesAreThrownAway) {
  for (const std::uint8_t stray : std::initializer_list<std::uint8_t>{0x00, 0xff, 0x01, 0x04}) {
    for (const auto& [before, behind] :
         {std::pair<std::size_t, std::size_t>{1, 0}, {2, 0}, {4, 0}, {0, 1}, {0, 4}, {1, 1}, {3, 2}}) {
      const Outcome outcome = ask_once([&](ScriptedLine& line, const Bytes& request) {
        Bytes bytes(before, stray);
        for (const std::uint8_t byte : good_reply(request)) bytes.push_back(byte);
        bytes.resize(bytes.size() + behind, stray);
        line.send(bytes);
      });
      EXPECT_EQ(outcome.status, BusStatus::ok)
          << before << " bytes before and " << behind << " bytes after the response, value " << int{stray}
          << ": " << outcome.detail;
      EXPECT_TRUE(outcome.open_after);
    }
  }
}

TEST(ModbusRtuLink, FiveAdditionalBytesAreADefect) {
  expect_end(ask_once(
                 [](ScriptedLine& line, const Bytes& request) {
                   Bytes bytes(5, 0);
                   for (const std::uint8_t byte : good_reply(request)) bytes.push_back(byte);
                   line.send(bytes);
                 },
                 listening_long()),
             BusStatus::bad_reply, "unit");
}

TEST(ModbusRtuLink, StrayBytesBetweenTwoRequestsAreIgnored) {
  ScriptedLine line([&](ScriptedLine& self, const Bytes& request, std::size_t) {
    self.send(good_reply(request));
    self.wait(20ms);
    self.send({0, 0xff, 0});
  });
  ModbusRtuLink link(line_at(line.device()));
  ASSERT_EQ(link.open(now() + generous), BusStatus::ok);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok) << link.detail();
    EXPECT_TRUE(right(link));
    ScriptedLine::wait(60ms);
  }
}

TEST(ModbusRtuLink, ALostRequestIsRepeatedAndASecondResponseIgnored) {
  for (const bool lost : {true, false}) {
    ScriptedLine line([lost](ScriptedLine& self, const Bytes& request, std::size_t index) {
      if (index == 0 && lost) return;
      if (index == 0)
        self.wait(130ms);  // this response is late; the module responds to all later requests as well
      const std::size_t one = 8;
      for (std::size_t at = 0; at + one <= request.size(); at += one) {
        const auto first = request.begin() + static_cast<std::ptrdiff_t>(at);
        self.send(good_reply(Bytes(first, first + one)));
      }
    });
    SerialLine settings = line_at(line.device());
    settings.habits.repeat_after_s = 0.05;
    ModbusRtuLink link(settings);
    ASSERT_EQ(link.open(now() + generous), BusStatus::ok);
    ASSERT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok) << link.detail();
    EXPECT_TRUE(right(link));
    ASSERT_EQ(link.ask(1, {.function = 4, .address = 9, .count = 2}, now() + generous), BusStatus::ok)
        << link.detail();
    EXPECT_EQ(word_at(link.data(), 0), 1009)
        << "the data must not come from the second response to the previous request";
    EXPECT_TRUE(link.is_open());
  }
}

// A module may send a message when it starts. The link must not interpret this message as a response.
TEST(ModbusRtuLink, SendsNothingBeforeTheSettlingTimeEnds) {
  std::atomic<Nanoseconds> first_request{0};
  ScriptedLine line([&](ScriptedLine& self, const Bytes& request, std::size_t index) {
    if (index == 0) first_request = now();
    self.send(good_reply(request));
  });
  SerialLine settings = line_at(line.device());
  settings.habits.settle_s = 0.2;
  ModbusRtuLink link(settings);
  const Nanoseconds before = now();
  ASSERT_EQ(link.open(before + generous), BusStatus::ok);
  line.send({'r', 'e', 'a', 'd', 'y', '\r', '\n'});
  ASSERT_EQ(link.settle(before + generous), BusStatus::ok) << link.detail();
  ASSERT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok) << link.detail();
  EXPECT_GE(first_request - before, 200'000'000);
}

TEST(ModbusRtuLink, RemovesTheEchoAndReportsACorruptedEcho) {
  SerialLine settings = line_at("");
  settings.echo = true;
  const Outcome outcome = ask_once(
      [](ScriptedLine& line, const Bytes& request) {
        line.send(request);
        line.send(good_reply(request));
      },
      settings);
  EXPECT_EQ(outcome.status, BusStatus::ok) << outcome.detail;
  expect_end(ask_once(
                 [](ScriptedLine& line, const Bytes& request) {
                   Bytes collided = request;
                   collided[2] = 0x55;
                   line.send(collided);
                 },
                 settings),
             BusStatus::bad_reply, "a second client (master)");
}

TEST(ModbusRtuLink, ExceptionsKeepTheSession) {
  const Outcome outcome = ask_once([](ScriptedLine& line, const Bytes&) {
    line.send(checked({1, 0x84, 2}));
  });
  EXPECT_EQ(outcome.status, BusStatus::exception);
  EXPECT_TRUE(outcome.open_after);
  EXPECT_NE(outcome.detail.find("exception 2"), std::string::npos) << outcome.detail;
}

TEST(ModbusRtuLink, KeepsTheSilentIntervalBetweenRequests) {
  ScriptedLine line(
      [](ScriptedLine& self, const Bytes& request, std::size_t) { self.send(good_reply(request)); });
  SerialLine settings = line_at(line.device());
  settings.silence_s = 0.03;
  ModbusRtuLink link(settings);
  ASSERT_EQ(link.open(now() + generous), BusStatus::ok);
  Nanoseconds answered = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok);
    if (i > 0) {
      EXPECT_GE(now() - answered, 29'000'000);
    }
    answered = now();
  }
}

TEST(ModbusRtuLink, ReconnectsToAnAdapterWithTheSameName) {
  const std::string name = (std::filesystem::temp_directory_path() / "softgrip_rtu_link_name").string();
  const auto behave = [](ScriptedLine& self, const Bytes& request, std::size_t) {
    self.send(good_reply(request));
  };
  auto line = std::make_unique<ScriptedLine>(behave, name);
  ModbusRtuLink link(line_at(name));
  ASSERT_EQ(link.open(now() + generous), BusStatus::ok) << link.detail();
  ASSERT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok);
  line.reset();
  EXPECT_EQ(link.ask(1, read_two, now() + deadline), BusStatus::disconnected) << link.detail();
  EXPECT_EQ(link.open(now() + deadline), BusStatus::disconnected);
  EXPECT_NE(std::string(link.detail()).find(name), std::string::npos) << link.detail();
  line = std::make_unique<ScriptedLine>(behave, name);
  EXPECT_EQ(link.open(now() + generous), BusStatus::ok) << link.detail();
  EXPECT_EQ(link.ask(1, read_two, now() + generous), BusStatus::ok) << link.detail();
  EXPECT_TRUE(right(link));
}

TEST(ModbusRtuLink, ReportsADeviceThatIsNoSerialLine) {
  const std::string file = (std::filesystem::temp_directory_path() / "softgrip_no_tty").string();
  std::ofstream(file) << "x";
  for (const auto& [device, why] :
       {std::pair<std::string, std::string>{"/dev/absent", "No such file"}, {file, "Inappropriate"}}) {
    ModbusRtuLink link(line_at(device));
    EXPECT_EQ(link.open(now() + deadline), BusStatus::disconnected);
    EXPECT_NE(std::string(link.detail()).find(why), std::string::npos) << link.detail();
  }
  std::filesystem::remove(file);
}

TEST(ModbusRtuLink, RefusesASecondClientOnTheSameLine) {
  ScriptedLine line(
      [](ScriptedLine& self, const Bytes& request, std::size_t) { self.send(good_reply(request)); });
  ModbusRtuLink first(line_at(line.device()));
  ModbusRtuLink second(line_at(line.device()));
  ASSERT_EQ(first.open(now() + generous), BusStatus::ok);
  EXPECT_EQ(second.open(now() + deadline), BusStatus::disconnected);
  EXPECT_NE(std::string(second.detail()).find("busy"), std::string::npos) << second.detail();
  first.close();
  EXPECT_EQ(second.open(now() + generous), BusStatus::ok) << second.detail();
}

/// Checks the duration that the link calculates for an exchange. This exchange writes one register and reads
/// one register. Its frames have 31 bytes in total.
TEST(ModbusRtuLink, TheExchangeTimeIncludesBytesSilencesAndLatencies) {
  const std::vector<TransactionSize> pair{{5, 5}, {5, 4}};  // function codes 6 and 3, each for one register
  const auto cost_ms = [&](std::uint32_t baud) {
    return 1e3 * ModbusRtuLink(line_at("/dev/x", baud)).cost(pair, "plan").exchange_s;
  };
  EXPECT_NEAR(cost_ms(9600), 46.9, 0.1);
  EXPECT_NEAR(cost_ms(115200), 9.7, 0.1);
  SerialLine slow = line_at("/dev/x", 115200);
  slow.turnaround_s = 0.005;
  slow.adapter_latency_s = 0.016;
  const Board::Budget cost = ModbusRtuLink(slow).cost(pair, "plan");
  EXPECT_NEAR(cost.exchange_s, 9.69e-3 + 2 * 21e-3, 1e-4);
  EXPECT_EQ(
      cost.explanation,
      "115200 8N1, plan: 31 bytes (2.69 ms) + silences (4 x 1.75 ms = 7 ms) + response times (2 x 21 ms = "
      "42 ms; turnaround 5 ms and adapter 16 ms, not measured because the board has not been connected "
      "yet)");
}

TEST(SerialPort, CharacterTimeAndSilenceFollowFromTheFormat) {
  SerialLine line = line_at("x", 9600);
  EXPECT_DOUBLE_EQ(character_s(line), 10.0 / 9600);
  EXPECT_DOUBLE_EQ(silence_s(line), 35.0 / 9600);
  ASSERT_TRUE(set_format("8E2", line));
  EXPECT_DOUBLE_EQ(character_s(line), 12.0 / 9600);
  EXPECT_EQ(format_of(line), "9600 8E2");
  EXPECT_FALSE(set_format("7E1", line));
  line.baud = 38400;
  EXPECT_DOUBLE_EQ(silence_s(line), 1.75e-3);
  line.silence_s = 0.002;
  EXPECT_DOUBLE_EQ(silence_s(line), 0.002);
}

TEST(SerialPort, TheAdaptersLatencyIsReadFromSysfs) {
  namespace fs = std::filesystem;
  const fs::path root = fs::temp_directory_path() / "softgrip_sys";
  fs::remove_all(root);
  fs::create_directories(root / "class/tty/ttyUSB7/device");
  fs::create_directories(root / "dev");
  std::ofstream(root / "class/tty/ttyUSB7/device/latency_timer") << "16\n";
  std::ofstream(root / "dev/ttyUSB7") << "";
  fs::create_symlink(root / "dev/ttyUSB7", root / "dev/by-name");
  const auto found = adapter_latency((root / "dev/by-name").string(), root.string());
  ASSERT_TRUE(found.has_value());
  EXPECT_DOUBLE_EQ(found->seconds, 0.016);
  EXPECT_NE(found->path.find("ttyUSB7/device/latency_timer"), std::string::npos);
  EXPECT_FALSE(adapter_latency((root / "dev/absent").string(), root.string()).has_value());
  fs::remove(root / "class/tty/ttyUSB7/device/latency_timer");
  EXPECT_FALSE(adapter_latency((root / "dev/by-name").string(), root.string()).has_value());
  fs::remove_all(root);
}

}  // namespace
}  // namespace softgrip::drivers::modbus_rtu_link_test
