// Tests a board that consists of several Modbus modules.

#include "drivers/modbus/modbus_board.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <utility>

#include "base/clock.h"
#include "base/descriptor.h"
#include "tests/drivers/modbus/modbus_board_fixture.h"

namespace softgrip::drivers::modbus_modules_test {
namespace {

using namespace std::chrono_literals;
using test::generous;
using test::ModbusBoardTest;
using test::RegisterServer;
using test::Requests;
using test::ScriptedServer;
using test::shipped;

/// A TCP port that discards all requests for a connection, as a host without power does. The queue of the
/// listening socket is full.
class SilentPort {
 public:
  SilentPort() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listener_.get(), generic, size), 0);
    EXPECT_EQ(::listen(listener_.get(), 0), 0);
    EXPECT_EQ(::getsockname(listener_.get(), generic, &size), 0);
    port_ = ntohs(address.sin_port);
    for (Descriptor& waiting : queue_) {
      waiting = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      (void)::connect(waiting.get(), generic, size);
    }
  }
  [[nodiscard]] TcpAddress address() const { return {.host = "127.0.0.1", .port = port_}; }

 private:
  Descriptor listener_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::array<Descriptor, 4> queue_;
  std::uint16_t port_ = 0;
};

/// Tests a board whose outputs belong to one Modbus module and whose inputs belong to another module.
class TwoModules : public ModbusBoardTest {
 protected:
  TwoModules() {
    for (std::uint16_t input = 0; input < 8; ++input) inputs_->set_input(input, 5000);
    wiring_ = test::two_fingers();
    for (ChannelWiring& channel : wiring_) {
      channel.displacement.module = 1;
      channel.pressure->module = 1;
    }
    settings_ = {.links = {TcpAddress{"127.0.0.1", server_.port()}, TcpAddress{"127.0.0.1", inputs_->port()}},
                 .modules = {{.name = "out", .map = shipped("waveshare-ao8-b.yaml"), .unit = 1, .link = 0},
                             {.name = "in", .map = shipped("waveshare-ai8-b.yaml"), .unit = 1, .link = 1}},
                 .wiring = wiring_,
                 .probes = 2};
    board_ = std::make_unique<ModbusBoard>(settings_);
  }

  /// Puts the module with the inputs and its link before the module with the outputs.
  void put_inputs_first() {
    std::swap(settings_.links[0], settings_.links[1]);
    std::swap(settings_.modules[0], settings_.modules[1]);
    for (std::size_t i = 0; i < 2; ++i) settings_.modules[i].link = i;
    for (ChannelWiring& channel : settings_.wiring) {
      channel.valve.module = 1;
      channel.displacement.module = 0;
      channel.pressure->module = 0;
    }
  }
  ModbusModuleSettings& input_module() {
    return settings_.modules[settings_.modules[0].name == "in" ? 0 : 1];
  }
  ModbusModuleSettings& output_module() {
    return settings_.modules[settings_.modules[0].name == "out" ? 0 : 1];
  }
  /// Connects a new board twice. Expects that each session writes the commands, that connect() leaves time
  /// until its deadline, and that the failed exchange names the module with the inputs.
  void expect_writes_without_the_inputs(const std::string& reason) {
    constexpr auto deadline = 800ms;
    board_ = std::make_unique<ModbusBoard>(settings_);
    for (std::uint16_t session = 1; session <= 2; ++session) {
      SCOPED_TRACE("session " + std::to_string(session));
      const Nanoseconds start = monotonic_now();
      ASSERT_EQ(board_->connect(deadline), BusStatus::ok) << board_->detail();
      EXPECT_LT(monotonic_now() - start, std::chrono::nanoseconds(deadline).count());
      EXPECT_EQ(exchange(10 * session, 20 * session), BusStatus::disconnected);
      EXPECT_NE(std::string(board_->detail()).find("module 'in': "), std::string::npos) << board_->detail();
      EXPECT_NE(std::string(board_->detail()).find(reason), std::string::npos) << board_->detail();
      EXPECT_EQ(server_.holding(0), 1000 * session);
      EXPECT_EQ(server_.holding(1), 2000 * session);
    }
  }

  std::unique_ptr<RegisterServer> inputs_ = std::make_unique<RegisterServer>();
  ModbusSettings settings_;
};

TEST_F(TwoModules, AreOneBoard) {
  EXPECT_TRUE(problems_of(settings_).empty());
  ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
  (void)server_.take_requests();
  (void)inputs_->take_requests();
  inputs_->set_input(1, 8000);
  ASSERT_EQ(exchange(40, 60), BusStatus::ok) << board_->detail();
  EXPECT_EQ(server_.take_requests(), (Requests{{16, 0, 0, 0, {4000, 6000}}, {3, 0, 2, 0, {}}}));
  EXPECT_EQ(inputs_->take_requests(), (Requests{{4, 0, 6, 0, {}}}));
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, 20);
  EXPECT_DOUBLE_EQ(readings_[1].displacement_mm, 35);
  EXPECT_DOUBLE_EQ(readings_[0].pressure_kpa, 50);
  EXPECT_DOUBLE_EQ(readings_[1].command_readback_kpa, 60);
  EXPECT_FALSE(board_->has_watchdog());
  EXPECT_NE(board_->describe().find("; Waveshare AI 8CH (B) at"), std::string::npos) << board_->describe();
  EXPECT_NE(board_->budget().explanation.find("; then Modbus TCP, 1 round trip (in: FC4 reads 6 from 0)"),
            std::string::npos)
      << board_->budget().explanation;
}

TEST_F(TwoModules, WriteOutputsWithoutTheInputModule) {
  ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
  ASSERT_EQ(exchange(40, 60), BusStatus::ok) << board_->detail();
  inputs_.reset();
  EXPECT_EQ(exchange(40, 60), BusStatus::disconnected);
  EXPECT_NE(std::string(board_->detail()).find("'in'"), std::string::npos) << board_->detail();
  ASSERT_EQ(board_->connect(generous), BusStatus::ok)
      << "for a connection, only the output module must respond";
  EXPECT_EQ(exchange(0, 0), BusStatus::disconnected);
  EXPECT_EQ(server_.holding(0), 0) << "a board without a watchdog must also receive the rest pressures";
  EXPECT_EQ(server_.holding(1), 0);
}

TEST_F(TwoModules, WriteOutputsWhileTheInputModuleDropsConnections) {
  const SilentPort silent;
  settings_.links[1] = silent.address();
  expect_writes_without_the_inputs("connecting: the deadline passed");
}

TEST_F(TwoModules, WriteOutputsWhileTheFirstModuleDropsConnections) {
  const SilentPort silent;
  settings_.links[1] = silent.address();
  put_inputs_first();
  expect_writes_without_the_inputs("connecting: the deadline passed");
}

TEST_F(TwoModules, WriteTheSetupOfTheOutputModuleWhileTheFirstModuleDropsConnections) {
  const SilentPort silent;
  settings_.links[1] = silent.address();
  put_inputs_first();
  output_module().map.setup = {{.function = 6, .address = 100, .value = 7}};
  input_module().map.setup = {{.function = 6, .address = 100, .value = 8}};
  expect_writes_without_the_inputs("connecting: the deadline passed");
  EXPECT_EQ(server_.holding(100), 7);
}

TEST_F(TwoModules, WriteOutputsWhileTheInputModuleAcceptsConnectionsButDoesNotRespond) {
  const ScriptedServer silent([](test::Peer&, const test::Bytes&, std::size_t) {});
  settings_.links[1] = TcpAddress{"127.0.0.1", silent.port()};
  for (const bool with_setup : {false, true}) {
    SCOPED_TRACE(with_setup ? "with setup" : "without setup");
    if (with_setup) input_module().map.setup = {{.function = 6, .address = 100, .value = 8}};
    ModbusBoard board(settings_);
    ASSERT_EQ(board.connect(400ms), BusStatus::ok) << board.detail();
    const std::vector<double> commands{30, 50};
    EXPECT_EQ(board.exchange(commands, readings_, 200ms), BusStatus::disconnected);
    EXPECT_NE(std::string(board.detail()).find("'in': waiting for the reply"), std::string::npos)
        << board.detail();
    EXPECT_EQ(server_.holding(0), 3000);
    server_.set_holding(0, 0);
  }
}

TEST_F(TwoModules, WriteOutputsWhileTheInputModuleRefusesItsSetup) {
  inputs_->refuse(6);
  input_module().map.setup = {{.function = 6, .address = 100, .value = 8}};
  expect_writes_without_the_inputs("refused function 6");
  inputs_->refuse(std::nullopt);
  ASSERT_EQ(board_->connect(generous), BusStatus::ok) << board_->detail();
  EXPECT_EQ(exchange(40, 60), BusStatus::ok) << board_->detail();
  EXPECT_EQ(inputs_->holding(100), 8);
}

/// Both modules have the same link, as on a serial line. Unit 1 has the outputs, and unit 2 has the inputs.
TEST_F(TwoModules, WriteOutputsOverALinkSharedWithASilentInputModule) {
  std::atomic<std::uint16_t> written{0};
  std::atomic<std::uint16_t> set_up{0};
  const ScriptedServer gateway([&](test::Peer& peer, const test::Bytes& request, std::size_t) {
    if (request.at(6) != 1) return;
    if (request.at(7) == 3) {
      peer.send(test::registers_reply(request, [&](std::uint16_t) { return written.load(); }));
      return;
    }
    (request.at(7) == 6 ? set_up : written) = test::word(request, request.at(7) == 6 ? 10 : 13);
    peer.send(test::frame_for(request, {request.begin() + 7, request.begin() + 12}));
  });
  settings_.links = {TcpAddress{"127.0.0.1", gateway.port()}};
  for (ModbusModuleSettings& module : settings_.modules) module.link = 0;
  input_module().unit = 2;
  output_module().map.setup = {{.function = 6, .address = 100, .value = 7}};
  for (const bool with_setup : {false, true}) {
    SCOPED_TRACE(with_setup ? "with setup" : "without setup");
    if (with_setup) input_module().map.setup = {{.function = 6, .address = 100, .value = 8}};
    ModbusBoard board(settings_);
    set_up = 0;
    ASSERT_EQ(board.connect(800ms), BusStatus::ok) << board.detail();
    EXPECT_EQ(set_up, 7);
    const std::vector<double> commands{with_setup ? 50.0 : 30.0, 10};
    EXPECT_EQ(board.exchange(commands, readings_, 200ms), BusStatus::disconnected);
    EXPECT_NE(std::string(board.detail()).find("'in': waiting for the reply"), std::string::npos)
        << board.detail();
    EXPECT_EQ(written, with_setup ? 5000 : 3000);
  }
}

TEST_F(TwoModules, NeedTheOutputModuleForASession) {
  settings_.links[0] = TcpAddress{"127.0.0.1", 1};
  ModbusBoard board(settings_);
  EXPECT_EQ(board.connect(500ms), BusStatus::disconnected);
}

TEST_F(TwoModules, AModuleWithoutAWireIsAProblem) {
  for (ChannelWiring& channel : settings_.wiring) channel.displacement.module = 0;
  const std::vector<std::string> problems = problems_of(settings_);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_NE(problems[0].find("out has no input 0"), std::string::npos) << problems[0];
}

}  // namespace
}  // namespace softgrip::drivers::modbus_modules_test
