#include "daemon/service/board_lock.h"

#include <gtest/gtest.h>

#include <unistd.h>

namespace softgrip::daemon::board_lock_test {
namespace {

rig::RigFile rig_at(const std::string& host, std::uint16_t port, std::uint8_t unit = 1) {
  drivers::ModbusSettings modbus;
  modbus.links.emplace_back(drivers::TcpAddress{host, port});
  drivers::ModbusModuleSettings module;
  module.unit = unit;
  module.map.outputs.registers.count = 2;
  modbus.modules.push_back(module);
  rig::RigFile rig;
  rig.board = modbus;
  return rig;
}

TEST(BoardLock, OneMasterPerBoardUnderWhateverSpelling) {
  auto first = BoardLock::take(rig_at("::1", 40502));
  ASSERT_TRUE(first) << first.error();
  const auto second = BoardLock::take(rig_at("0:0::1", 40502));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find("modbus ::1 port 40502 unit 1"), std::string::npos) << second.error();
  EXPECT_NE(second.error().find("process " + std::to_string(getpid())), std::string::npos) << second.error();
  EXPECT_TRUE(BoardLock::take(rig_at("::1", 40503))) << "another port";
  EXPECT_TRUE(BoardLock::take(rig_at("::1", 40502, 2))) << "another unit behind a gateway";
  *first = BoardLock();
  EXPECT_TRUE(BoardLock::take(rig_at("::1", 40502))) << "it was let go";
}

TEST(BoardLock, AnAddressWithinTheOtherFamilyIsTheSameBoard) {
  const auto first = BoardLock::take(rig_at("127.0.0.1", 40502));
  ASSERT_TRUE(first) << first.error();
  EXPECT_FALSE(BoardLock::take(rig_at("::ffff:127.0.0.1", 40502)));
  EXPECT_FALSE(BoardLock::take(rig_at("::FFFF:7f00:1", 40502)));
}

TEST(BoardLock, ASerialLineHasOneMasterWhateverUnitItAsks) {
  rig::RigFile one = rig_at("", 0, 1);
  rig::RigFile two = rig_at("", 0, 2);
  const auto device = [](rig::RigFile& rig) -> std::string& {
    auto& links = std::get<drivers::ModbusSettings>(rig.board).links;
    links = {drivers::SerialLine{}};
    return std::get<drivers::SerialLine>(links[0]).device;
  };
  device(one) = "/dev/null";
  device(two) = "/dev/../dev/null";
  const auto first = BoardLock::take(one);
  ASSERT_TRUE(first) << first.error();
  EXPECT_FALSE(BoardLock::take(two));
}

TEST(BoardLock, NothingIsDrivenByASimulatedBoardNorByAModuleOfInputs) {
  rig::RigFile simulated;
  simulated.board = simulation::SimulatedBoardSettings{};
  EXPECT_TRUE(driven_by(simulated).empty());
  rig::RigFile inputs = rig_at("127.0.0.1", 502);
  std::get<drivers::ModbusSettings>(inputs.board).modules[0].map.outputs.registers.count = 0;
  EXPECT_TRUE(driven_by(inputs).empty());
}

}  // namespace
}  // namespace softgrip::daemon::board_lock_test
