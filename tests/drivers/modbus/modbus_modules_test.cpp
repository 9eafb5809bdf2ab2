// Tests a board that consists of several Modbus modules.

#include "drivers/modbus/modbus_board.h"

#include <gtest/gtest.h>

#include "tests/drivers/modbus/modbus_board_fixture.h"

namespace softgrip::drivers::modbus_modules_test {
namespace {

using namespace std::chrono_literals;
using test::generous;
using test::ModbusBoardTest;
using test::RegisterServer;
using test::Requests;
using test::shipped;

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
