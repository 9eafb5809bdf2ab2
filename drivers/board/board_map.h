#pragma once
// Defines the contents of a board file (config/boards/*.yaml): the registers of an I/O board and their
// meaning. load_board_map() in rig/board_map_file.h reads the file. The Modbus board and the emulator use the
// values. docs/reference/board-map.md describes the file.
// Defines a straight line through two calibration points. Every scaling in a rig file or board file is a line
// of this kind. The slope may be positive or negative.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/enum_table.h"

namespace softgrip::drivers {

/// The line through (x0, y0) and (x1, y1). For example, {4, 85, 20, 15} describes a sensor with 4-20 mA whose
/// reading decreases as the current increases. x0 and x1 must differ; x_at() also requires that y0 and y1
/// differ. wiring_problems() and the loaders of the files check these conditions.
struct TwoPoints {
  double x0 = 0;
  double y0 = 0;
  double x1 = 1;
  double y1 = 1;

  [[nodiscard]] constexpr double y_at(double x) const noexcept {
    return y0 + (x - x0) * ((y1 - y0) / (x1 - x0));
  }
  [[nodiscard]] constexpr double x_at(double y) const noexcept {
    return x0 + (y - y0) * ((x1 - x0) / (y1 - y0));
  }

  bool operator==(const TwoPoints&) const = default;
};

/// The format in which registers contain a number.
enum class RegisterKind : std::uint8_t { uint16, int16, uint32, int32, float32 };
/// The order of the two words of a number with two registers, and of the two bytes of each register.
/// high_first: the high word has the lower address.
enum class WordOrder : std::uint8_t {
  high_first,
  low_first,
  high_first_bytes_swapped,
  low_first_bytes_swapped,
};
/// Names of the word orders in board files.
inline constexpr auto word_order_names =
    enum_names<WordOrder>({{WordOrder::high_first, "high_first"},
                           {WordOrder::low_first, "low_first"},
                           {WordOrder::high_first_bytes_swapped, "high_first_bytes_swapped"},
                           {WordOrder::low_first_bytes_swapped, "low_first_bytes_swapped"}});
[[nodiscard]] constexpr std::string_view name_of(WordOrder order) noexcept {
  return word_order_names[order];
}
/// The unit of the quantity at a terminal. A pressure generator has an air port as terminal, with the unit
/// kPa.
enum class ElectricalUnit : std::uint8_t { volt, milliampere, kilopascal };
inline constexpr auto unit_names = enum_names<ElectricalUnit>(
    {{ElectricalUnit::volt, "V"}, {ElectricalUnit::milliampere, "mA"}, {ElectricalUnit::kilopascal, "kPa"}});

/// Returns the number of registers that a number of this kind occupies: 1 or 2.
[[nodiscard]] constexpr std::uint16_t words_of(RegisterKind kind) noexcept {
  return kind == RegisterKind::uint16 || kind == RegisterKind::int16 ? 1 : 2;
}
/// Names of the kinds in board files.
inline constexpr auto register_kind_names = enum_names<RegisterKind>({{RegisterKind::uint16, "uint16"},
                                                                      {RegisterKind::int16, "int16"},
                                                                      {RegisterKind::uint32, "uint32"},
                                                                      {RegisterKind::int32, "int32"},
                                                                      {RegisterKind::float32, "float32"}});
[[nodiscard]] constexpr std::string_view name_of(RegisterKind kind) noexcept {
  return register_kind_names[kind];
}
/// Returns the symbol of a unit: "V", "mA" or "kPa".
[[nodiscard]] constexpr std::string_view name_of(ElectricalUnit unit) noexcept {
  return unit_names[unit];
}

/// Consecutive numbers of one kind. `address` is the address in the Modbus request: the address in the board
/// file minus address_base of this file.
struct RegisterBlock {
  std::uint8_t function = 0;  ///< function code for reading (1 to 4) or for writing (5, 6, 16)
  std::uint16_t address = 0;
  std::uint16_t count = 0;  ///< number of values in the block; each value occupies one or two registers
  RegisterKind kind = RegisterKind::uint16;

  [[nodiscard]] constexpr std::uint16_t registers() const noexcept {
    return static_cast<std::uint16_t>(count * words_of(kind));
  }
  /// Returns the address of the number `index`. A result above 65535 means that the address does not exist;
  /// the result does not wrap around to 0.
  [[nodiscard]] constexpr std::uint32_t address_of(std::size_t index) const noexcept {
    return static_cast<std::uint32_t>(address + index * words_of(kind));
  }
};

/// The input terminals or the output terminals of a module: their registers and the scaling of the raw
/// numbers. `registers.count` is 0 if the module has no terminals of this direction.
struct TerminalBlock {
  RegisterBlock registers;
  ElectricalUnit unit = ElectricalUnit::volt;
  TwoPoints scaling;   ///< line from the raw number (x) to the value in `unit` (y)
  double raw_min = 0;  ///< lower end of the range of the converter; a command outside this range is limited
                       ///< to the range
  double raw_max = 0;
  int bits = 0;                    ///< resolution over [raw_min, raw_max]; 0: no quantisation (float)
  std::vector<double> error_raws;  ///< raw numbers of the inputs that are error codes and not measured values
};

/// Status registers of the inputs, and the meaning of the numbers in them. A number whose meaning the board
/// file does not give counts as a sensor error.
struct StatusBlock {
  RegisterBlock registers;
  std::vector<std::uint16_t> ok;
  std::vector<std::uint16_t> over;
  std::vector<std::uint16_t> under;
};

/// Registers in which the board reports its outputs.
struct ReadBack {
  RegisterBlock registers;   ///< registers to read; the numbers in these registers have the kind and the
                             ///< scaling of the outputs
  double tolerance_raw = 0;  ///< largest difference between the reported and the written value [raw number];
                             ///< a larger difference means that the board refused the write
  /// Largest number of exchanges until the board reports a written value. During these exchanges, the values
  /// of earlier writes are accepted too.
  std::uint32_t lag_exchanges = 0;
};

/// A write of a fixed value to one register or coil.
struct FixedWrite {
  std::uint8_t function = 0;  ///< function code of the write: 5, 6 or 16
  std::uint16_t address = 0;
  std::uint16_t value = 0;  ///< value to write; for a coil 0 or 1
  /// Value of every second write of a heartbeat, if the board expects that the value changes.
  std::optional<std::uint16_t> alternate{};
};

/// The watchdog of the board, which sets the outputs to their safe value if the daemon sends no requests.
struct BoardWatchdog {
  enum class Kind : std::uint8_t {
    none,                   ///< no watchdog: the outputs keep their last value for an unlimited time
    communication_timeout,  ///< outputs go to the safe value timeout_s after the last request that feeds the
                            ///< watchdog
  };
  enum class Feed : std::uint8_t {
    any_request,  ///< each request that the board receives feeds the watchdog
    functions,    ///< a request feeds the watchdog if its function code is one of `functions`
    feed_write,   ///< only the write `feed_write` feeds the watchdog; each exchange contains this write
  };
  /// The registers or bits in which the board reports that its watchdog has tripped.
  struct Tripped {
    std::uint8_t function = 0;  ///< function code 1 or 2 (coil, discrete input), or 3 or 4 (register)
    std::uint16_t address = 0;
    std::uint16_t mask = 0xffff;  ///< the watchdog has tripped if (number & mask) is not 0 for at least one
                                  ///< of `count` numbers
    std::uint16_t count = 1;      ///< number of registers or bits, one per output
  };

  /// The register that contains the number of clients of the board.
  struct ClientCount {
    std::uint8_t function = 0;  ///< function code of the read: 3 or 4
    std::uint16_t address = 0;
  };

  Kind kind = Kind::none;
  double timeout_s = 0;                 ///< time-out in the board [s]; `setup` or a tool of the vendor sets
                                        ///< this time-out
  std::vector<double> safe_electrical;  ///< safe value of each output, in the unit of the output
  Feed feed = Feed::any_request;
  std::vector<std::uint8_t> functions;
  std::optional<FixedWrite> feed_write;
  std::optional<Tripped> tripped;      ///< registers or bits in which the board reports that its watchdog has
                                       ///< tripped
  std::vector<FixedWrite> clear;       ///< writes that end the tripped state of the watchdog, in this order;
                                       ///< empty: any write ends this state
  std::optional<ClientCount> clients;  ///< register with the number of clients of the board, including this
                                       ///< program

  /// Returns true if requests of a client that only reads also feed the watchdog.
  [[nodiscard]] bool fed_by_reading() const noexcept {
    constexpr std::uint8_t last_that_reads = 4;
    const bool reads = std::any_of(functions.begin(), functions.end(),
                                   [](std::uint8_t function) { return function <= last_that_reads; });
    return kind != Kind::none && (feed == Feed::any_request || (feed == Feed::functions && reads));
  }
};
/// Names of the ways to feed a watchdog, in board files.
inline constexpr auto feed_names =
    enum_names<BoardWatchdog::Feed>({{BoardWatchdog::Feed::any_request, "any_request"},
                                     {BoardWatchdog::Feed::functions, "functions"},
                                     {BoardWatchdog::Feed::feed_write, "feed_write"}});

/// The contents of a board file.
struct BoardMap {
  std::string name;
  std::string source;    ///< origin of the register numbers in the file, in one line
  int address_base = 0;  ///< number that the board file uses for the first register; used only in messages
  WordOrder word_order = WordOrder::high_first;
  TerminalBlock inputs;
  TerminalBlock outputs;
  /// Largest number of registers in one request of this board. The Modbus specification allows 125 for a
  /// read.
  std::uint16_t max_registers = 125;
  /// True if the board supports function code 23. A request with this function code writes the outputs and
  /// reads the inputs in one transaction.
  bool has_fc23 = false;
  /// Largest gap between two register blocks that one request may include [registers]. The board must permit
  /// reading the registers in the gap.
  std::uint16_t readable_gap = 0;
  std::optional<StatusBlock> input_status;
  std::optional<ReadBack> read_back;
  BoardWatchdog watchdog;
  /// Writes that follow the opening of a session, in this order. A tripped watchdog is cleared before these
  /// writes.
  std::vector<FixedWrite> setup;

  [[nodiscard]] bool has_inputs() const noexcept { return inputs.registers.count > 0; }
  [[nodiscard]] bool has_outputs() const noexcept { return outputs.registers.count > 0; }
};

}  // namespace softgrip::drivers
