#include "rig/board_map_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "document/reader.h"
#include "drivers/modbus/modbus_message.h"

namespace softgrip::rig {
namespace {

using document::MapReader;
using document::Node;
using document::Range;

constexpr int fc_write_coil = 5;
constexpr int fc_write_register = 6;
constexpr int fc_write_registers = 16;
constexpr int fc_read_holding = 3;
constexpr std::int64_t last_address = 0xffff;

Range raw_range(drivers::RegisterKind kind) {
  switch (kind) {
    case drivers::RegisterKind::uint16:
      return {0, 0xffff};
    case drivers::RegisterKind::int16:
      return {-0x8000, 0x7fff};
    case drivers::RegisterKind::uint32:
      return {0, 4294967295.0};
    case drivers::RegisterKind::int32:
      return {-2147483648.0, 2147483647.0};
    case drivers::RegisterKind::float32:
      return {-static_cast<double>(std::numeric_limits<float>::max()),
              static_cast<double>(std::numeric_limits<float>::max())};
  }
  return {};
}

/// Reads the parts of one board file.
class BoardReader {
 public:
  BoardReader(const document::Document& document, document::Problems& problems)
      : document_(document), problems_(problems) {}

  drivers::BoardMap board() {
    MapReader in(document_, document_.root, problems_, "the board");
    map_.name = in.text("name");
    map_.source = in.text("source");
    map_.address_base = static_cast<int>(in.integer("address_base", {0, 1}));
    map_.word_order = in.choice("word_order", drivers::word_order_names);
    map_.max_registers = static_cast<std::uint16_t>(
        in.optional_integer("max_registers", {1, drivers::max_read_registers}).value_or(map_.max_registers));
    map_.has_fc23 = in.boolean("fc23");
    map_.readable_gap = static_cast<std::uint16_t>(in.optional_integer("readable_gap", {0, 120}).value_or(0));
    if (const Node* node = in.child("inputs", !in.has("outputs"))) inputs(*node);
    if (const Node* node = in.child("outputs", !in.has("inputs"))) outputs(*node);
    if (const Node* node = in.child("input_status", false)) input_status(*node);
    if (const Node* node = in.child("read_back", false)) read_back(*node);
    if (const Node* node = in.child("watchdog", true)) watchdog(*node);
    for (const Node* node : in.sequence("setup", false)) {
      map_.setup.push_back(fixed_write(*node, "a write of the setup"));
    }
    check_directions(in);
    check_fc23(in);
    check_max_registers(in);
    return std::move(map_);
  }

 private:
  /// Returns the address to use in Modbus requests for the key `address` of the file.
  std::uint16_t address(MapReader& in, std::int64_t registers) {
    const std::int64_t base = map_.address_base;
    const std::int64_t number =
        in.integer("address", {static_cast<double>(base), static_cast<double>(base + last_address)});
    if (number - base + registers > last_address + 1) {
      in.report("address", "the block of registers ends beyond the last register of the board");
    }
    return static_cast<std::uint16_t>(number - base);
  }

  std::uint8_t function(MapReader& in, const std::vector<int>& allowed, const std::string& meaning) {
    const std::int64_t code = in.integer("function", {1, 23});
    if (std::find(allowed.begin(), allowed.end(), code) == allowed.end()) {
      in.report("function", "`function` is " + std::to_string(code) + ", " + meaning + ": " +
                                with_commas(allowed, [](int one) { return std::to_string(one); }));
    }
    return static_cast<std::uint8_t>(code);
  }

  void scaling(MapReader& in, drivers::TerminalBlock& block) {
    const std::size_t before = problems_.size();
    const std::vector<double> raw = in.numbers("at_raw", 2, {});
    block.unit = in.has("is_ma")    ? drivers::ElectricalUnit::milliampere
                 : in.has("is_kpa") ? drivers::ElectricalUnit::kilopascal
                                    : drivers::ElectricalUnit::volt;
    const std::string key = "is" + std::string(suffix_of(block.unit));
    const std::vector<double> electrical = in.numbers(key, 2, {-1000, 1000});
    block.scaling = {raw[0], electrical[0], raw[1], electrical[1]};
    // If at_raw or the electrical values could not be read, the two scaling points are not compared.
    if (problems_.size() != before || !in.has("at_raw") || !in.has(key)) return;
    if (raw[0] == raw[1]) in.report("at_raw", "the values of the two scaling points must differ");
    if (electrical[0] == electrical[1]) in.report(key, "the values of the two scaling points must differ");
  }

  void converter(MapReader& in, drivers::TerminalBlock& block) {
    const drivers::RegisterKind kind = block.registers.kind;
    block.raw_min = in.number("raw_min", raw_range(kind));
    block.raw_max = in.number("raw_max", raw_range(kind));
    if (block.raw_min >= block.raw_max) in.report("raw_max", "`raw_max` must be above `raw_min`");
    const bool is_float = kind == drivers::RegisterKind::float32;
    block.bits = static_cast<int>(in.integer("bits", {is_float ? 0.0 : 1.0, 32}));
    if (!is_float && std::exp2(block.bits) - 1 > block.raw_max - block.raw_min) {
      in.report("bits", "`bits` is too large for the range from `raw_min` to `raw_max`");
    }
  }

  void terminals(MapReader& in, drivers::TerminalBlock& block, const std::vector<int>& functions,
                 std::int64_t most_registers) {
    drivers::RegisterBlock& registers = block.registers;
    registers.kind = in.choice("kind", drivers::register_kind_names);
    registers.count = static_cast<std::uint16_t>(
        in.integer("count", {1, static_cast<double>(most_registers / words_of(registers.kind))}));
    registers.function = function(in, functions, "allowed is");
    registers.address = address(in, registers.registers());
    scaling(in, block);
    converter(in, block);
  }

  void inputs(const Node& node) {
    MapReader in(document_, node, problems_, "the inputs");
    terminals(in, map_.inputs, {3, 4}, drivers::max_read_registers);
    for (const Node* item : in.sequence("error_raws", false)) {
      const auto raw = document::number_in(document_, *item, raw_range(map_.inputs.registers.kind), problems_,
                                           "an error code");
      if (raw.has_value()) map_.inputs.error_raws.push_back(*raw);
    }
  }

  void outputs(const Node& node) {
    MapReader in(document_, node, problems_, "the outputs");
    terminals(in, map_.outputs, {fc_write_register, fc_write_registers}, drivers::max_fc23_write_registers);
    const drivers::RegisterBlock& registers = map_.outputs.registers;
    if (registers.function == fc_write_register && words_of(registers.kind) > 1) {
      in.report("function",
                "function 6 writes one register, but each of the outputs of this board map consists of two "
                "registers",
                "use 16");
    }
  }

  std::vector<std::uint16_t> status_values(MapReader& in, std::string_view key, bool required) {
    std::vector<std::uint16_t> values;
    for (const Node* item : in.sequence(key, required)) {
      const auto value = document::number_in(document_, *item, {0, 0xffff}, problems_, "a status value");
      if (!value.has_value()) continue;
      if (*value != std::floor(*value)) {
        problems_.add(document_.problem(item->at, "a status value must be a whole number"));
      }
      values.push_back(static_cast<std::uint16_t>(*value));
    }
    return values;
  }

  void input_status(const Node& node) {
    MapReader in(document_, node, problems_, "the input status");
    drivers::StatusBlock block;
    block.registers.count = map_.inputs.registers.count;
    block.registers.function = function(in, {3, 4}, "allowed is");
    block.registers.address = address(in, block.registers.registers());
    block.ok = status_values(in, "ok", true);
    block.over = status_values(in, "over", false);
    block.under = status_values(in, "under", false);
    if (in.has("ok") && block.ok.empty())
      in.report("ok", "list at least one status value that means a valid input");
    map_.input_status = block;
  }

  void read_back(const Node& node) {
    MapReader in(document_, node, problems_, "the read-back");
    drivers::ReadBack block;
    block.registers = map_.outputs.registers;
    block.registers.function = function(in, {3, 4}, "allowed is");
    block.registers.address = address(in, block.registers.registers());
    block.tolerance_raw = in.number("tolerance_raw", {0, 4294967295.0});
    block.lag_exchanges =
        static_cast<std::uint32_t>(in.optional_integer("lag_exchanges", {0, 100}).value_or(0));
    map_.read_back = block;
  }

  /// Parses the entry of one write to a register or coil. If `heartbeat` is true, the entry may contain a
  /// second value. The two values are then written to the board alternately.
  drivers::FixedWrite fixed_write(const Node& node, const std::string& what, bool heartbeat = false) {
    MapReader in(document_, node, problems_, what);
    drivers::FixedWrite write;
    write.function = function(in, {fc_write_coil, fc_write_register, fc_write_registers},
                              "the function of a write must be one of");
    write.address = address(in, 1);
    const double largest = write.function == fc_write_coil ? 1 : 0xffff;
    write.value = value_of(in, largest);
    if (!heartbeat) return write;
    if (const auto alternate = in.optional_integer("alternate", {0, largest})) {
      write.alternate = static_cast<std::uint16_t>(*alternate);
      if (in.good("alternate") && in.good("value") && write.alternate == write.value)
        in.report("alternate",
                  "`alternate` must differ from `value`, because the board waits for a change of the value");
    }
    return write;
  }

  /// Reads the value of a write. The value may also be the text functions_1_to_16 or functions_17_to_32. For
  /// such a text, computes the bit mask of the function codes in this group that feed the watchdog.
  std::uint16_t value_of(MapReader& in, double largest) {
    const Node* const node = in.child("value", true);
    if (node == nullptr) return 0;
    if (largest > 1 && node->scalar == "functions_1_to_16") return functions_mask(1);
    if (largest > 1 && node->scalar == "functions_17_to_32") return functions_mask(17);
    return static_cast<std::uint16_t>(in.integer("value", {0, largest}));
  }

  std::uint16_t functions_mask(unsigned first) const {
    unsigned mask = 0;
    for (const std::uint8_t code : map_.watchdog.functions) {
      if (code >= first && code < first + 16) mask |= 1U << (code - first);
    }
    return static_cast<std::uint16_t>(mask);
  }

  std::vector<drivers::FixedWrite> fixed_writes(const Node& node, const std::string& what) {
    if (node.kind != Node::Kind::sequence) return {fixed_write(node, what)};
    std::vector<drivers::FixedWrite> writes;
    for (const Node& item : node.items) writes.push_back(fixed_write(item, what));
    return writes;
  }

  drivers::BoardWatchdog::Tripped tripped(const Node& node) {
    MapReader in(document_, node, problems_, "the watchdog's tripped state");
    drivers::BoardWatchdog::Tripped state;
    state.function = function(in, {1, 2, 3, 4}, "the function of a read must be one of");
    state.count = static_cast<std::uint16_t>(
        in.optional_integer("count", {1, drivers::max_read_registers}).value_or(1));
    state.address = address(in, state.count);
    state.mask = static_cast<std::uint16_t>(in.optional_integer("mask", {1, 0xffff}).value_or(0xffff));
    return state;
  }

  drivers::BoardWatchdog::ClientCount client_count(const Node& node) {
    MapReader in(document_, node, problems_, "the count of clients");
    drivers::BoardWatchdog::ClientCount count;
    count.function = function(in, {3, 4}, "the function that reads a register must be one of");
    count.address = address(in, 1);
    return count;
  }

  void watchdog(const Node& node) {
    MapReader in(document_, node, problems_, "the watchdog");
    drivers::BoardWatchdog& watchdog = map_.watchdog;
    const std::size_t before = problems_.size();
    if (in.choice("kind", {"communication_timeout", "none"}) == 1) return;
    // If the kind is misspelt, other keys of the map show that it describes a watchdog.
    if (problems_.size() != before && in.keys().size() <= 1) return;
    watchdog.kind = drivers::BoardWatchdog::Kind::communication_timeout;
    watchdog.timeout_s = in.number("timeout_s", {0.001, 3600});
    watchdog.safe_electrical = in.numbers("safe" + std::string(suffix_of(map_.outputs.unit)),
                                          map_.outputs.registers.count, {-1000, 1000});
    watchdog.feed = in.choice("fed_by", drivers::feed_names);
    if (watchdog.feed == drivers::BoardWatchdog::Feed::functions) feeding_functions(in);
    if (watchdog.feed == drivers::BoardWatchdog::Feed::feed_write) {
      if (const Node* write = in.child("feed_write", true)) {
        watchdog.feed_write = fixed_write(*write, "the feeding write", true);
      }
    }
    if (const Node* state = in.child("tripped", false)) watchdog.tripped = tripped(*state);
    if (const Node* write = in.child("clear", false)) {
      watchdog.clear = fixed_writes(*write, "the write that clears the watchdog");
    }
    if (const Node* count = in.child("clients", false)) watchdog.clients = client_count(*count);
  }

  /// Reads the function codes that feed the watchdog. One of them must be the function code that writes the
  /// outputs, because every exchange contains a request with this code.
  void feeding_functions(MapReader& in) {
    std::vector<std::uint8_t>& functions = map_.watchdog.functions;
    for (const Node* item : in.sequence("functions", true)) {
      const auto code = document::number_in(document_, *item, {1, 127}, problems_, "a function code");
      if (code.has_value()) functions.push_back(static_cast<std::uint8_t>(*code));
    }
    const std::uint8_t used = map_.has_fc23 ? std::uint8_t{23} : map_.outputs.registers.function;
    if (used < fc_write_register) return;  // the error was already reported for the outputs
    if (std::find(functions.begin(), functions.end(), used) == functions.end()) {
      in.report("functions", "the outputs are written by function " + std::to_string(used) +
                                 ", but this function does not reset the watchdog");
    }
  }

  /// Reports keys that need outputs if the board has no outputs, and keys that need inputs if it has no
  /// inputs.
  void check_directions(MapReader& in) {
    const auto needs = [&](std::string_view key, const std::string& direction) {
      if (in.has(key) && !in.has(direction)) {
        in.report(key, "`" + std::string(key) + "` needs `" + direction +
                           "`, but this board map has no such section");
      }
    };
    needs("input_status", "inputs");
    needs("read_back", "outputs");
    if (map_.watchdog.kind != drivers::BoardWatchdog::Kind::none) needs("watchdog", "outputs");
    if (map_.has_fc23) {
      needs("fc23", "inputs");
      needs("fc23", "outputs");
    }
  }

  void check_fc23(MapReader& in) {
    if (!map_.has_fc23 || !in.has("inputs") || !in.has("outputs")) return;
    if (map_.inputs.registers.function != fc_read_holding) {
      in.report("fc23", "function 23 reads holding registers, but the inputs are read by function " +
                            std::to_string(map_.inputs.registers.function));
    }
    if (map_.outputs.registers.function != fc_write_registers) {
      in.report("fc23", "function 23 writes several registers, so `function` of the outputs must be 16");
    }
  }

  /// Checks that one request can read a complete number. If two requests were needed, the two halves of the
  /// number could be of different times.
  void check_max_registers(MapReader& in) {
    if (!in.good("max_registers")) return;
    std::uint16_t least = 1;
    if (map_.has_inputs()) least = std::max(least, words_of(map_.inputs.registers.kind));
    if (map_.has_outputs()) least = std::max(least, words_of(map_.outputs.registers.kind));
    const auto& tripped = map_.watchdog.tripped;
    if (tripped && tripped->function >= fc_read_holding) least = std::max(least, tripped->count);
    if (map_.max_registers >= least) return;
    in.report("max_registers", "`max_registers` is " + std::to_string(map_.max_registers) + ", but " +
                                   std::to_string(least) +
                                   " consecutive registers must be read in one request");
  }

  const document::Document& document_;
  document::Problems& problems_;
  drivers::BoardMap map_;
};

}  // namespace

std::optional<drivers::BoardMap> read_board_map(const document::Document& document,
                                                document::Problems& problems) {
  const std::size_t before = problems.size();
  drivers::BoardMap map = BoardReader(document, problems).board();
  if (problems.full() || problems.size() != before) return std::nullopt;
  return map;
}

std::optional<drivers::BoardMap> load_board_map(const std::string& path, document::Problems& problems) {
  const std::size_t before = problems.size();
  const document::Document document = document::parse_file(path, problems);
  if (problems.full() || problems.size() != before) return std::nullopt;
  return read_board_map(document, problems);
}

}  // namespace softgrip::rig
