#include "drivers/modbus_server/registers.h"

#include <gtest/gtest.h>
#include <modbus/modbus.h>

#include <array>

namespace softgrip::modbus::registers_test {
namespace {

/// A register map with holding registers 0 to 3, input registers 10 and 11, and coil 5. A client may write
/// only the holding registers 2 and 3.
constexpr std::array<std::uint8_t, 7> functions{MODBUS_FC_READ_COILS,
                                                MODBUS_FC_READ_HOLDING_REGISTERS,
                                                MODBUS_FC_READ_INPUT_REGISTERS,
                                                MODBUS_FC_WRITE_SINGLE_COIL,
                                                MODBUS_FC_WRITE_SINGLE_REGISTER,
                                                MODBUS_FC_WRITE_MULTIPLE_REGISTERS,
                                                MODBUS_FC_WRITE_AND_READ_REGISTERS};

class RegistersTest : public testing::Test {
 protected:
  RegistersTest() {
    registers.define_holding(0, Registers::Access::read_only, 0x1234);
    registers.define_holding(1, Registers::Access::read_only, 0xffff);
    registers.define_holding(2, Registers::Access::read_write);
    registers.define_holding(3, Registers::Access::read_write);
    registers.define_input(10, 7);
    registers.define_input(11, 8);
    registers.define_coil(5, true);
    for (const std::uint8_t function : functions) registers.allow(function);
  }

  Bytes ask(const Bytes& pdu) { return registers.answer(pdu).pdu; }

  static constexpr std::uint8_t illegal_address = 2;
  static constexpr std::uint8_t illegal_value = 3;
  Registers registers;
};

TEST_F(RegistersTest, ReadsHoldingAndInputRegisters) {
  EXPECT_EQ(ask({0x03, 0, 0, 0, 2}), (Bytes{0x03, 4, 0x12, 0x34, 0xff, 0xff}));
  EXPECT_EQ(ask({0x04, 0, 10, 0, 2}), (Bytes{0x04, 4, 0, 7, 0, 8}));
  EXPECT_EQ(ask({0x01, 0, 5, 0, 1}), (Bytes{0x01, 1, 1}));
}

TEST_F(RegistersTest, WritesOneOrSeveralRegisters) {
  EXPECT_EQ(ask({0x06, 0, 2, 0xab, 0xcd}), (Bytes{0x06, 0, 2, 0xab, 0xcd}));
  EXPECT_EQ(registers.holding(2), 0xabcd);
  EXPECT_EQ(ask({0x10, 0, 2, 0, 2, 4, 0, 1, 0, 2}), (Bytes{0x10, 0, 2, 0, 2}));
  EXPECT_EQ(registers.holding(2), 1);
  EXPECT_EQ(registers.holding(3), 2);
  EXPECT_EQ(ask({0x05, 0, 5, 0, 0}), (Bytes{0x05, 0, 5, 0, 0}));
  EXPECT_FALSE(registers.coil(5));
}

TEST_F(RegistersTest, BothReadFunctionsReadAnUnambiguousAddress) {
  EXPECT_EQ(ask({0x04, 0, 0, 0, 1}), (Bytes{0x04, 2, 0x12, 0x34}));
  EXPECT_EQ(ask({0x03, 0, 10, 0, 2}), (Bytes{0x03, 4, 0, 7, 0, 8}));
  registers.define_input(0, 0x5555);
  EXPECT_EQ(ask({0x04, 0, 0, 0, 1}), (Bytes{0x04, 2, 0x55, 0x55}))
      << "the address exists in both tables, so the function code selects the table";
  EXPECT_EQ(ask({0x03, 0, 0, 0, 1}), (Bytes{0x03, 2, 0x12, 0x34}));
}

TEST_F(RegistersTest, Function23WritesBeforeReading) {
  EXPECT_EQ(ask({0x17, 0, 2, 0, 1, 0, 2, 0, 1, 2, 0x55, 0x66}), (Bytes{0x17, 2, 0x55, 0x66}));
}

TEST_F(RegistersTest, RefusesUndefinedAndReadOnlyAddresses) {
  EXPECT_EQ(ask({0x03, 0, 3, 0, 2}), (Bytes{0x83, illegal_address}))
      << "the requested range exceeds the register table";
  EXPECT_EQ(ask({0x03, 0xff, 0xff, 0, 2}), (Bytes{0x83, illegal_address}))
      << "the end of the requested range exceeds the largest address";
  EXPECT_EQ(ask({0x04, 0, 12, 0, 1}), (Bytes{0x84, illegal_address}));
  EXPECT_EQ(ask({0x06, 0, 0, 0, 1}), (Bytes{0x86, illegal_address})) << "the register is read-only";
  EXPECT_EQ(ask({0x10, 0, 1, 0, 2, 4, 0, 1, 0, 2}), (Bytes{0x90, illegal_address}))
      << "one register of the requested range is read-only";
  EXPECT_EQ(registers.holding(2), 0) << "a refused write changes nothing";
  EXPECT_EQ(ask({0x17, 0, 9, 0, 1, 0, 2, 0, 1, 2, 0, 1}), (Bytes{0x97, illegal_address}));
  EXPECT_EQ(registers.holding(2), 0) << "a refused read-write writes nothing";
}

TEST_F(RegistersTest, RefusesQuantitiesAndLengthsThatDoNotFit) {
  EXPECT_EQ(ask({0x03, 0, 0, 0, 0}), (Bytes{0x83, illegal_value}));
  EXPECT_EQ(ask({0x03, 0, 0, 0, 126}), (Bytes{0x83, illegal_value}));
  EXPECT_EQ(ask({0x03, 0, 0}), (Bytes{0x83, illegal_value}));
  EXPECT_EQ(ask({0x10, 0, 2, 0, 2, 4, 0, 1}), (Bytes{0x90, illegal_value}));
  EXPECT_EQ(ask({0x10, 0, 2, 0, 2, 3, 0, 1, 0}), (Bytes{0x90, illegal_value}));
  EXPECT_EQ(ask({0x05, 0, 5, 0x12, 0x34}), (Bytes{0x85, illegal_value}));
  EXPECT_EQ(ask({0x17, 0, 2, 0, 1, 0, 2}), (Bytes{0x97, illegal_value}));
}

TEST_F(RegistersTest, RefusesFunctionsThatTheBoardDoesNotHave) {
  EXPECT_EQ(ask({0x2b, 0x0e, 1, 0}), (Bytes{0xab, 1}));
  Registers bare;
  EXPECT_EQ(bare.answer(Bytes{0x03, 0, 0, 0, 1}).pdu, (Bytes{0x83, 1}));
}

TEST_F(RegistersTest, ReportsSuccessfulWrites) {
  EXPECT_TRUE(registers.answer(Bytes{0x06, 0, 2, 0, 0}).wrote);
  EXPECT_FALSE(registers.answer(Bytes{0x06, 0, 0, 0, 0}).wrote);
  EXPECT_FALSE(registers.answer(Bytes{0x03, 0, 0, 0, 1}).wrote);
}

}  // namespace
}  // namespace softgrip::modbus::registers_test
