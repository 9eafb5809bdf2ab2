#include "rig/board_map_file.h"

#include <gtest/gtest.h>

namespace softgrip::rig::board_map_file_test {
namespace {

using namespace drivers;

const std::string boards = SOFTGRIP_SOURCE_DIR "/config/boards/";

/// A small valid board map. The tests change lines of this map.
const std::string valid = R"(name: test
source: a test
address_base: 1
word_order: high_first
fc23: false
inputs:
  function: 4
  address: 1
  count: 6
  kind: uint16
  at_raw: [0, 65535]
  is_v: [-10, 10]
  raw_min: 0
  raw_max: 65535
  bits: 16
outputs:
  function: 16
  address: 11
  count: 2
  kind: uint16
  at_raw: [0, 4095]
  is_ma: [4, 20]
  raw_min: 0
  raw_max: 4095
  bits: 12
input_status: {function: 4, address: 21, ok: [0], over: [1], under: [2]}
read_back: {function: 3, address: 11, tolerance_raw: 1}
watchdog:
  kind: communication_timeout
  timeout_s: 0.5
  safe_ma: [4, 4]
  fed_by: functions
  functions: [16]
  tripped: {function: 1, address: 33}
  clear: {function: 5, address: 33, value: 1}
setup:
  - {function: 6, address: 101, value: 5}
)";

struct Result {
  std::optional<BoardMap> map;
  document::Problems problems;
};

Result read(const std::string& text) {
  Result result;
  const document::Document document = document::parse("board.yaml", text, result.problems);
  result.map = read_board_map(document, result.problems);
  return result;
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = valid;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BoardMapFile, EveryKeyIsReadIntoTheBoardMap) {
  const Result result = read(valid);
  ASSERT_TRUE(result.map.has_value()) << result.problems.format();
  const BoardMap& map = *result.map;
  EXPECT_EQ(map.inputs.registers.address, 0) << "addresses start at 1 in the file and at 0 on the bus";
  EXPECT_EQ(map.inputs.registers.function, 4);
  EXPECT_EQ(map.inputs.registers.count, 6);
  EXPECT_EQ(map.inputs.unit, ElectricalUnit::volt);
  EXPECT_EQ(map.inputs.scaling, (TwoPoints{0, -10, 65535, 10}));
  EXPECT_EQ(map.outputs.registers.address, 10);
  EXPECT_EQ(map.outputs.unit, ElectricalUnit::milliampere);
  EXPECT_EQ(map.outputs.bits, 12);
  ASSERT_TRUE(map.input_status.has_value());
  EXPECT_EQ(map.input_status->registers.address, 20);
  EXPECT_EQ(map.input_status->registers.count, 6);
  EXPECT_EQ(map.input_status->under, std::vector<std::uint16_t>{2});
  ASSERT_TRUE(map.read_back.has_value());
  EXPECT_EQ(map.read_back->registers.count, 2);
  EXPECT_EQ(map.read_back->registers.function, 3);
  EXPECT_EQ(map.watchdog.kind, BoardWatchdog::Kind::communication_timeout);
  EXPECT_EQ(map.watchdog.safe_electrical, (std::vector<double>{4, 4}));
  EXPECT_EQ(map.watchdog.feed, BoardWatchdog::Feed::functions);
  ASSERT_TRUE(map.watchdog.tripped.has_value());
  EXPECT_EQ(map.watchdog.tripped->address, 32);
  ASSERT_EQ(map.watchdog.clear.size(), 1U);
  EXPECT_EQ(map.watchdog.clear[0].function, 5);
  ASSERT_EQ(map.setup.size(), 1U);
  EXPECT_EQ(map.setup[0].address, 100);
}

TEST(BoardMapFile, ShippedBoardsAreValid) {
  for (const std::string name : {"adam-6024.yaml", "softgrip-sim.yaml"}) {
    document::Problems problems;
    EXPECT_TRUE(load_board_map(boards + name, problems).has_value()) << problems.format();
  }
}

TEST(BoardMapFile, TheAdamMapHasTheRegistersOfTheManual) {
  document::Problems problems;
  const auto map = load_board_map(boards + "adam-6024.yaml", problems);
  ASSERT_TRUE(map.has_value()) << problems.format();
  EXPECT_EQ(map->inputs.registers.address, 0);  // register 40001 has address 0
  EXPECT_EQ(map->inputs.registers.count, 6);
  EXPECT_EQ(map->outputs.registers.address, 10);  // register 40011 has address 10
  EXPECT_EQ(map->outputs.registers.count, 2);
  ASSERT_TRUE(map->input_status.has_value());
  EXPECT_EQ(map->input_status->registers.address, 20);  // register 40021 has address 20
  EXPECT_DOUBLE_EQ(map->inputs.scaling.y_at(65535), 10);
  EXPECT_DOUBLE_EQ(map->outputs.scaling.x_at(10), 4095);
}

struct Mistake {
  std::string from;
  std::string to;
  std::string message;
  std::string line;  ///< part of the line that the message must quote
};

void expect_one_problem(const Mistake& mistake) {
  const Result result = read(changed(mistake.from, mistake.to));
  EXPECT_FALSE(result.map.has_value()) << mistake.to;
  ASSERT_EQ(result.problems.size(), 1U) << mistake.to << '\n' << result.problems.format();
  const document::Problem& problem = result.problems.list()[0];
  EXPECT_NE(problem.message.find(mistake.message), std::string::npos) << problem.message;
  EXPECT_NE(problem.line_text.find(mistake.line), std::string::npos) << result.problems.format();
}

TEST(BoardMapFile, AddressBaseAndWordOrderHaveNoDefault) {
  expect_one_problem({"address_base: 1\n", "", "address_base", "name: test"});
  expect_one_problem({"word_order: high_first\n", "", "word_order", "name: test"});
  expect_one_problem({"address_base: 1", "address_base: 40001", "allowed is 0 to 1", "address_base: 40001"});
}

TEST(BoardMapFile, EachMistakeIsReportedOnceWithTheLine) {
  const std::vector<Mistake> mistakes{
      {"fc23: false\n", "", "fc23", "name: test"},
      {"word_order: high_first", "word_order: big", "high_first", "big"},
      {"word_order: high_first", "word_order: high_first_bytes_swaped", "high_first_bytes_swapped", "swaped"},
      {"word_order: high_first", "word_order: high_first\nmax_registers: 126", "125", "max_registers: 126"},
      {"  function: 4\n  address: 1\n", "  function: 16\n  address: 1\n", "3, 4", "function: 16"},
      {"  function: 4\n  address: 1\n", "  function: 4\n  address: 0\n", "address", "address: 0"},
      {"  address: 1\n  count: 6", "  address: 65536\n  count: 6", "beyond the last register", "65536"},
      {"  kind: uint16\n  at_raw: [0, 65535]", "  kind: uint8\n  at_raw: [0, 65535]", "uint16", "uint8"},
      {"at_raw: [0, 65535]", "at_raw: [7, 7]", "must differ", "[7, 7]"},
      {"at_raw: [0, 65535]", "at_raw: [0]", "2 numbers", "at_raw: [0]"},
      {"is_v: [-10, 10]", "is_v: [.nan, 10]", "number", "nan"},
      {"is_v: [-10, 10]", "is_v: [3, 3]", "must differ", "[3, 3]"},
      {"raw_max: 65535", "raw_max: 65536", "allowed", "65536"},
      {"bits: 12", "bits: 13", "is too large for the range", "bits: 13"},
      {"  function: 16\n  address: 11", "  function: 5\n  address: 11", "6, 16", "function: 5"},
      {"ok: [0]", "ok: []", "at least one status value", "ok: []"},
      {"tolerance_raw: 1", "tolerance_raw: -1", "allowed", "tolerance_raw: -1"},
      {"kind: communication_timeout", "kind: sometimes", "communication_timeout", "sometimes"},
      {"timeout_s: 0.5", "timeout_s: 0", "allowed", "timeout_s: 0"},
      {"timeout_s: 0.5", "timeout_ms: 500", "timeout_ms", "timeout_ms: 500"},
      {"safe_ma: [4, 4]", "safe_ma: [4]", "2 numbers", "safe_ma: [4]"},
      {"functions: [16]", "functions: [3, 4]", "does not reset the watchdog", "[3, 4]"},
      {"value: 1}", "value: 2}", "allowed", "value: 2"},
      {"value: 5}", "value: 70000}", "allowed", "70000"},
      {"name: test", "name: test\ncolour: red", "unknown key", "colour: red"},
  };
  for (const Mistake& mistake : mistakes) expect_one_problem(mistake);
}

TEST(BoardMapFile, Function23NeedsHoldingRegistersAndFunction16) {
  std::string text = changed("fc23: false", "fc23: true");
  text.replace(text.find("functions: [16]"), 15, "functions: [23]");
  text.replace(text.find("function: 16"), 12, "function: 6");
  const Result result = read(text);
  ASSERT_EQ(result.problems.size(), 2U) << result.problems.format();
  for (const document::Problem& problem : result.problems.list()) EXPECT_EQ(problem.at.line, 5);
}

TEST(BoardMapFile, ARequestMustContainAllRegistersOfANumber) {
  std::string text = changed("fc23: false", "fc23: false\nmax_registers: 1");
  text.replace(text.find("kind: uint16"), 12, "kind: int32");
  const Result result = read(text);
  ASSERT_EQ(result.problems.size(), 1U) << result.problems.format();
  EXPECT_NE(result.problems.list()[0].message.find("2 consecutive registers"), std::string::npos);
  EXPECT_EQ(result.problems.list()[0].at.line, 6);
}

TEST(BoardMapFile, Function6CannotWriteTwoRegisters) {
  std::string text = changed("  function: 16\n  address: 11\n  count: 2\n  kind: uint16\n",
                             "  function: 6\n  address: 11\n  count: 2\n  kind: float32\n");
  text.replace(text.find("functions: [16]"), 15, "functions: [6]");
  const Result result = read(text);
  ASSERT_EQ(result.problems.size(), 1U) << result.problems.format();
  EXPECT_NE(result.problems.list()[0].message.find(
                "each of the outputs of this board map consists of two registers"),
            std::string::npos);
}

std::string without(std::string text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  return text.erase(begin, text.find(to) - begin);
}

TEST(BoardMapFile, AModuleCanHaveOnlyInputsOrOnlyOutputs) {
  std::string outputs_only = without(without(valid, "inputs:", "outputs:"), "input_status:", "read_back:");
  const Result outputs = read(outputs_only);
  ASSERT_TRUE(outputs.map.has_value()) << outputs.problems.format();
  EXPECT_FALSE(outputs.map->has_inputs());
  EXPECT_TRUE(outputs.map->has_outputs());

  const std::string inputs_only =
      without(without(valid, "outputs:", "input_status:"), "read_back:", "setup:") +
      "watchdog: {kind: none}\n";
  const Result inputs = read(inputs_only);
  ASSERT_TRUE(inputs.map.has_value()) << inputs.problems.format();
  EXPECT_TRUE(inputs.map->has_inputs());
  EXPECT_FALSE(inputs.map->has_outputs());

  // A key that concerns the inputs, such as `input_status`, requires the key `inputs`. A key that concerns
  // the outputs, such as `read_back`, requires the key `outputs`. At least one of these two keys is required.
  EXPECT_NE(
      read(without(valid, "inputs:", "outputs:")).problems.format().find("`input_status` needs `inputs`"),
      std::string::npos);
  EXPECT_NE(read(without(valid, "outputs:", "input_status:")).problems.format().find("needs `outputs`"),
            std::string::npos);
  EXPECT_FALSE(read(without(without(valid, "inputs:", "outputs:"), "outputs:", "setup:")).map.has_value());
}

TEST(BoardMapFile, SeveralTripFlagsAndClearingWritesAreRead) {
  std::string text = valid;
  text.replace(text.find("{function: 1, address: 33}"), 26, "{function: 2, address: 33, count: 2}");
  text.replace(text.find("{function: 5, address: 33, value: 1}"), 36,
               "[{function: 5, address: 41, value: 1}, {function: 5, address: 42, value: 1}]");
  const Result result = read(text);
  ASSERT_TRUE(result.map.has_value()) << result.problems.format();
  EXPECT_EQ(result.map->watchdog.tripped->count, 2);
  ASSERT_EQ(result.map->watchdog.clear.size(), 2U);
  EXPECT_EQ(result.map->watchdog.clear[1].address, 41)
      << "addresses start at 1 in the file and at 0 on the bus";
}

TEST(BoardMapFile, TheClientCountMustBeARegister) {
  const std::string clear = "clear: {function: 5, address: 33, value: 1}";
  const auto with = [&](const std::string& count) {
    return read(changed(clear, clear + "\n  clients: " + count));
  };
  const Result result = with("{function: 4, address: 51}");
  ASSERT_TRUE(result.map.has_value()) << result.problems.format();
  ASSERT_TRUE(result.map->watchdog.clients.has_value());
  EXPECT_EQ(result.map->watchdog.clients->function, 4);
  EXPECT_EQ(result.map->watchdog.clients->address, 50)
      << "addresses start at 1 in the file and at 0 on the bus";
  EXPECT_FALSE(with("{function: 1, address: 51}").map.has_value());
  EXPECT_FALSE(with("{function: 3}").map.has_value());
  EXPECT_FALSE(read(valid).map->watchdog.clients.has_value());
}

TEST(BoardMapFile, FedByReadingIsFalseIfOnlyWritesFeedTheWatchdog) {
  const auto fed = [](const std::string& by) {
    const Result result = read(changed("fed_by: functions\n  functions: [16]", "fed_by: " + by));
    EXPECT_TRUE(result.map.has_value()) << result.problems.format();
    return result.map.has_value() && result.map->watchdog.fed_by_reading();
  };
  EXPECT_TRUE(fed("any_request"));
  EXPECT_TRUE(fed("functions\n  functions: [4, 16]"));
  EXPECT_FALSE(fed("functions\n  functions: [16, 23]"));
  EXPECT_FALSE(fed("feed_write\n  feed_write: {function: 6, address: 61, value: 1}"));
  BoardWatchdog none;
  EXPECT_FALSE(none.fed_by_reading());
}

TEST(BoardMapFile, AHeartbeatRequiresTwoDifferentValues) {
  const auto with = [](const std::string& second) {
    return read(changed(
        "fed_by: functions\n  functions: [16]",
        "fed_by: feed_write\n  feed_write: {function: 6, address: 61, value: 1, alternate: " + second + "}"));
  };
  const Result result = with("0");
  ASSERT_TRUE(result.map.has_value()) << result.problems.format();
  EXPECT_EQ(result.map->watchdog.feed_write->alternate, 0);
  EXPECT_NE(with("1").problems.format().find("`alternate` must differ from `value`"), std::string::npos);
  EXPECT_FALSE(with("70000").map.has_value());
  EXPECT_FALSE(
      read(changed("watchdog:", "setup: [{function: 6, address: 61, value: 1, alternate: 0}]\nwatchdog:"))
          .map.has_value())
      << "only a heartbeat may have alternating values";
}

/// The watchdog of some couplers is reset only by certain function codes, which a mask selects. The reader
/// computes this mask from the function codes in the file. It also checks that the mask includes the function
/// code that writes the outputs.
TEST(BoardMapFile, TheFunctionMaskIsComputedFromTheFunctionCodes) {
  std::string text = valid;
  text.replace(text.find("functions: [16]"), 15, "functions: [3, 16, 23]");
  text +=
      "  - {function: 6, address: 200, value: functions_1_to_16}\n"
      "  - {function: 6, address: 201, value: functions_17_to_32}\n";
  const Result result = read(text);
  ASSERT_TRUE(result.map.has_value()) << result.problems.format();
  ASSERT_EQ(result.map->setup.size(), 3U);
  EXPECT_EQ(result.map->setup[1].value, 0x8004);
  EXPECT_EQ(result.map->setup[2].value, 0x0040);
  EXPECT_FALSE(read(text + "  - {function: 6, address: 202, value: functions_33_to_48}\n").map.has_value());
}

TEST(BoardMapFile, TheWagoMapEnablesTheWatchdogForTheWriteFunction) {
  document::Problems problems;
  const auto map = load_board_map(boards + "wago-750-559.yaml", problems);
  ASSERT_TRUE(map.has_value()) << problems.format();
  std::uint16_t mask = 0;
  for (const FixedWrite& write : map->setup) mask = write.address == 0x1001 ? write.value : mask;
  EXPECT_NE(mask & 1U << (map->outputs.registers.function - 1), 0U);
}

TEST(BoardMapFile, TheFestoPgvaMapScalesZeroPressureToMidRange) {
  document::Problems problems;
  const auto map = load_board_map(boards + "festo-pgva.yaml", problems);
  ASSERT_TRUE(map.has_value()) << problems.format();
  EXPECT_EQ(map->outputs.unit, ElectricalUnit::kilopascal);
  EXPECT_DOUBLE_EQ(map->outputs.scaling.x_at(0), 2047.5);
  EXPECT_DOUBLE_EQ(map->outputs.scaling.x_at(10), 4.095 * 100 + 2047.5) << "10 kPa are 100 mbar";
  EXPECT_NEAR(map->inputs.scaling.y_at(2460), (0.244 * 2460 - 500) / 10, 1e-3);
}

TEST(BoardMapFile, AllProblemsAreReportedTogether) {
  const Result result = read("name: x\naddress_base: 7\ninputs: {function: 9}\nwatchdog: {kind: none}\n");
  EXPECT_FALSE(result.map.has_value());
  EXPECT_GT(result.problems.size(), 5U) << result.problems.format();
}

using drivers::ElectricalUnit;

TEST(ElectricalSuffix, IsTheUnitAtTheEndOfAKey) {
  EXPECT_EQ(suffix_of(ElectricalUnit::volt), "_v");
  EXPECT_EQ(suffix_of(ElectricalUnit::milliampere), "_ma");
  EXPECT_EQ(suffix_of(ElectricalUnit::kilopascal), "_kpa");
}

}  // namespace
}  // namespace softgrip::rig::board_map_file_test
