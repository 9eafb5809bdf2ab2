#include "drivers/modbus/exchange_plan.h"

#include <gtest/gtest.h>

#include "tests/drivers/modbus/two_fingers.h"

namespace softgrip::drivers::exchange_plan_test {
namespace {

/// Returns a board map. The 8 inputs begin at holding register 0. The 4 outputs begin at register 100. The
/// map has neither a status of the inputs nor a read-back of the outputs.
BoardMap plain_map() {
  BoardMap map;
  map.inputs.registers = {.function = 3, .address = 0, .count = 8, .kind = RegisterKind::uint16};
  map.outputs.registers = {.function = 16, .address = 100, .count = 4, .kind = RegisterKind::uint16};
  return map;
}

TEST(ExchangePlan, TwoChannelsNeedOneWriteAndOneRead) {
  const ExchangePlan plan = plan_exchange(plain_map(), test::two_fingers(false));
  EXPECT_EQ(plan.writes, (std::vector<WriteStep>{{16, 100, 2, 0}}));
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{3, 0, 2}}));
  EXPECT_EQ(plan.transactions(), 2U);
  EXPECT_EQ(plan.channels[1].displacement, (Slot{0, 1}));
}

TEST(ExchangePlan, ReadsInputsBetweenWiredInputsInOneRequest) {
  const ExchangePlan plan = plan_exchange(plain_map(), test::two_fingers(true));
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{3, 0, 6}}));
  EXPECT_EQ(plan.channels[1].pressure, (Slot{0, 5}));
}

TEST(ExchangePlan, ASharedThermometerIsReadOnce) {
  const ExchangePlan plan = plan_exchange(plain_map(), test::two_fingers_and_a_thermometer());
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{3, 0, 6}}));
  EXPECT_EQ(plan.channels[0].temperature, (Slot{0, 2}));
  EXPECT_EQ(plan.channels[1].temperature, (Slot{0, 2}));
  EXPECT_FALSE(plan_exchange(plain_map(), test::two_fingers()).channels[0].temperature);
}

TEST(ExchangePlan, NeighbouringBlocksAreReadTogether) {
  BoardMap map = plain_map();
  map.input_status =
      StatusBlock{.registers = {3, 8, 8, RegisterKind::uint16}, .ok = {0}, .over = {}, .under = {}};
  const ExchangePlan plan = plan_exchange(map, test::two_fingers(false));
  // The registers 2 to 7 lie between the wired inputs and the status. They are readable inputs of the board,
  // so one request can read all registers from 0 to 9.
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{3, 0, 10}}));
  EXPECT_EQ(plan.channels[1].displacement_status, (Slot{0, 9}));
}

TEST(ExchangePlan, GapsAreReadOnlyAsFarAsTheMapAllows) {
  BoardMap map = plain_map();
  map.read_back = ReadBack{.registers = {3, 20, 4, RegisterKind::uint16}, .tolerance_raw = 0};
  EXPECT_EQ(plan_exchange(map, test::two_fingers(false)).reads,
            (std::vector<ReadStep>{{3, 0, 2}, {3, 20, 2}}));
  map.readable_gap = 11;
  EXPECT_EQ(plan_exchange(map, test::two_fingers(false)).reads.size(), 2U);
  map.readable_gap = 12;  // registers 8 to 19 have no function, so the gap is 12 registers
  const ExchangePlan plan = plan_exchange(map, test::two_fingers(false));
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{3, 0, 22}}));
  EXPECT_EQ(plan.channels[0].read_back, (Slot{0, 20}));
}

TEST(ExchangePlan, LimitsAReadTo125Registers) {
  BoardMap map = plain_map();
  map.read_back = ReadBack{.registers = {3, 124, 4, RegisterKind::uint16}, .tolerance_raw = 0};
  map.readable_gap = 120;
  EXPECT_EQ(plan_exchange(map, test::two_fingers(false)).reads.size(), 2U);
  map.read_back->registers.address = 123;
  EXPECT_EQ(plan_exchange(map, test::two_fingers(false)).reads, (std::vector<ReadStep>{{3, 0, 125}}));
}

TEST(ExchangePlan, LimitsRequestsToTheBoardWithoutSplittingAValue) {
  BoardMap map = plain_map();
  map.max_registers = 3;
  map.inputs.registers.kind = RegisterKind::float32;
  map.outputs.registers.kind = RegisterKind::float32;
  const ExchangePlan plan = plan_exchange(map, test::two_fingers(true));  // inputs 0, 1, 4 and 5 are wired
  EXPECT_EQ(plan.writes, (std::vector<WriteStep>{{16, 100, 2, 0}, {16, 102, 2, 2}}));
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{3, 0, 2}, {3, 2, 2}, {3, 8, 2}, {3, 10, 2}}));
  EXPECT_EQ(plan.channels[1].displacement, (Slot{1, 0}));
  EXPECT_EQ(plan.channels[1].pressure, (Slot{3, 0}));
  map.max_registers = 4;
  EXPECT_EQ(plan_exchange(map, test::two_fingers(true)).reads, (std::vector<ReadStep>{{3, 0, 4}, {3, 8, 4}}))
      << "registers of inputs without wiring are read only if this saves a request";
}

TEST(ExchangePlan, ReadsEachFunctionCodeInASeparateRequest) {
  BoardMap map = plain_map();
  map.read_back = ReadBack{.registers = {4, 2, 4, RegisterKind::uint16}, .tolerance_raw = 0};
  map.watchdog.tripped = BoardWatchdog::Tripped{.function = 1, .address = 3, .mask = 1};
  const ExchangePlan plan = plan_exchange(map, test::two_fingers(false));
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{1, 3, 1}, {3, 0, 2}, {4, 2, 2}}));
  EXPECT_EQ(plan.tripped, (Slot{0, 0}));
  EXPECT_EQ(plan.sampling_read, 1U);
}

TEST(ExchangePlan, ReadsTheClientCountFromTheOutputModule) {
  BoardMap map = plain_map();
  map.watchdog.clients = BoardWatchdog::ClientCount{.function = 3, .address = 2};
  const ExchangePlan beside = plan_exchange(map, test::two_fingers(false));
  EXPECT_EQ(beside.reads, (std::vector<ReadStep>{{3, 0, 3}}))
      << "the register is adjacent to the inputs, so no additional request is required";
  EXPECT_EQ(beside.clients, (Slot{0, 2}));
  map.watchdog.clients = BoardWatchdog::ClientCount{.function = 4, .address = 40};
  EXPECT_EQ(plan_exchange(map, test::two_fingers(false)).reads,
            (std::vector<ReadStep>{{3, 0, 2}, {4, 40, 1}}));
  EXPECT_FALSE(plan_exchange(map, test::two_fingers(false), 1).clients.has_value())
      << "the register with the number of clients is on another I/O module than the channels that are read";
}

TEST(ExchangePlan, SplitsWritesAtAnUnusedOutput) {
  std::vector<ChannelWiring> wiring = test::two_fingers(false);
  wiring[0].valve.output = 3;
  wiring[1].valve.output = 0;
  const ExchangePlan plan = plan_exchange(plain_map(), wiring);
  EXPECT_EQ(plan.writes, (std::vector<WriteStep>{{16, 100, 1, 0}, {16, 103, 1, 1}}));
  EXPECT_EQ(plan.channels[0].output_word, 1U);
  EXPECT_EQ(plan.channels[1].output_word, 0U);
}

TEST(ExchangePlan, Function6WritesEachRegisterSeparately) {
  BoardMap map = plain_map();
  map.outputs.registers.function = 6;
  EXPECT_EQ(plan_exchange(map, test::two_fingers(false)).writes,
            (std::vector<WriteStep>{{6, 100, 1, 0}, {6, 101, 1, 1}}));
}

TEST(ExchangePlan, Function23SavesATransaction) {
  BoardMap map = plain_map();
  map.has_fc23 = true;
  const ExchangePlan plan = plan_exchange(map, test::two_fingers(false));
  EXPECT_EQ(plan.transactions(), 1U);
  EXPECT_EQ(describe(plan), "FC23 writes 2 from 100 and reads 2 from 0");
}

TEST(ExchangePlan, SixteenChannelsWithFloatsNeedTwoTransactions) {
  BoardMap map = plain_map();
  map.inputs.registers = {.function = 4, .address = 10, .count = 32, .kind = RegisterKind::float32};
  map.outputs.registers = {.function = 16, .address = 200, .count = 16, .kind = RegisterKind::float32};
  std::vector<ChannelWiring> wiring;
  for (std::size_t i = 0; i < 16; ++i) {
    ChannelWiring channel = test::two_fingers(false)[0];
    channel.valve.output = i;
    channel.displacement.input = 2 * i;
    wiring.push_back(channel);
  }
  const ExchangePlan plan = plan_exchange(map, wiring);
  EXPECT_EQ(plan.transactions(), 2U);
  EXPECT_EQ(plan.reads, (std::vector<ReadStep>{{4, 10, 62}}));
  EXPECT_EQ(plan.channels[15].displacement, (Slot{0, 60}));
  EXPECT_EQ(plan.output_words, 32U);
}

}  // namespace
}  // namespace softgrip::drivers::exchange_plan_test
