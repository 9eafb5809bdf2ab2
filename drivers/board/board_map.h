#pragma once
// What a board file (config/boards/*.yaml) says: where the registers of an I/O board are and what they mean.
// Plain values; read by load_board_map() in rig/board_map_file.h, used by the Modbus board and by the
// emulator. docs/reference/board-map.md is the manual of the file.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/board/two_points.h"

namespace softgrip::drivers {

/// What one number looks like in registers.
enum class RegisterKind : std::uint8_t { uint16, int16, uint32, int32, float32 };
/// Which word of a number of two registers comes first (the lower address), and whether the two bytes of
/// every register are swapped.
enum class WordOrder : std::uint8_t {
  high_first,
  low_first,
  high_first_bytes_swapped,
  low_first_bytes_swapped,
};
/// As the board file writes them.
[[nodiscard]] std::string_view name_of(WordOrder order) noexcept;
/// What a terminal carries. A pressure generator's "terminal" is its air port: it is told kilopascals.
enum class ElectricalUnit : std::uint8_t { volt, milliampere, kilopascal };

/// Registers that a number of this kind takes: 1 or 2.
[[nodiscard]] constexpr std::uint16_t words_of(RegisterKind kind) noexcept {
  return kind == RegisterKind::uint16 || kind == RegisterKind::int16 ? 1 : 2;
}
/// "uint16" ... "float32", as the board file writes them.
[[nodiscard]] std::string_view name_of(RegisterKind kind) noexcept;
/// "V", "mA", "kPa"
[[nodiscard]] std::string_view name_of(ElectricalUnit unit) noexcept;

/// Consecutive numbers of one kind. `address` is what goes over the wire (counted from 0): the loader has
/// subtracted the file's address_base.
struct RegisterBlock {
  std::uint8_t function = 0;  ///< function code that reads it (1-4) or writes it (5, 6, 16)
  std::uint16_t address = 0;
  std::uint16_t count = 0;  ///< numbers, not registers
  RegisterKind kind = RegisterKind::uint16;

  [[nodiscard]] constexpr std::uint16_t registers() const noexcept {
    return static_cast<std::uint16_t>(count * words_of(kind));
  }
  /// Address of the number `index`. Beyond 65535 no board has it, and it does not continue at 0.
  [[nodiscard]] constexpr std::uint32_t address_of(std::size_t index) const noexcept {
    return static_cast<std::uint32_t>(address + index * words_of(kind));
  }
};

/// Terminals of one direction: their registers and what the raw numbers mean at the terminal. A module that
/// has none of this direction has a count of 0.
struct TerminalBlock {
  RegisterBlock registers;
  ElectricalUnit unit = ElectricalUnit::volt;
  TwoPoints scaling;   ///< x: raw, y: in `unit`
  double raw_min = 0;  ///< what the converter can deliver or accept; outside, a write is refused
  double raw_max = 0;
  int bits = 0;                    ///< of the converter over [raw_min, raw_max]; 0: not quantised (float)
  std::vector<double> error_raws;  ///< raw numbers that are not values but error codes (inputs)
};

/// Status register of each input: what its numbers mean. Any other number is a sensor error.
struct StatusBlock {
  RegisterBlock registers;
  std::vector<std::uint16_t> ok;
  std::vector<std::uint16_t> over;
  std::vector<std::uint16_t> under;
};

/// Where the board says what it outputs.
struct ReadBack {
  RegisterBlock registers;   ///< same kind and scaling as the outputs
  double tolerance_raw = 0;  ///< a larger difference means that the write was refused
  /// So many exchanges the board may need until it shows what was written: earlier ones are accepted too.
  std::uint32_t lag_exchanges = 0;
};

/// One register or coil written with a fixed value.
struct FixedWrite {
  std::uint8_t function = 0;  ///< 5, 6 or 16
  std::uint16_t address = 0;
  std::uint16_t value = 0;  ///< of a coil: 0 or 1
  /// Of a heartbeat: every second write has this value, since the board wants to see a change.
  std::optional<std::uint16_t> alternate{};
};

/// The watchdog of the board itself, which acts when the daemon no longer does.
struct BoardWatchdog {
  enum class Kind : std::uint8_t {
    none,                   ///< outputs keep their last value for ever
    communication_timeout,  ///< outputs go to the safe value when the board was not fed for timeout_s
  };
  enum class Feed : std::uint8_t {
    any_request,  ///< whatever the board receives
    functions,    ///< only requests with one of `functions`
    feed_write,   ///< only the write `feed_write`, sent in every exchange
  };
  struct Tripped {
    std::uint8_t function = 0;  ///< 1 or 2 (a coil, an input) or 3, 4 (a register)
    std::uint16_t address = 0;
    std::uint16_t mask = 0xffff;  ///< tripped if (number & mask) is not 0 ...
    std::uint16_t count = 1;      ///< ... in any of so many (one per output)
  };

  /// A register.
  struct ClientCount {
    std::uint8_t function = 0;  ///< 3 or 4
    std::uint16_t address = 0;
  };

  Kind kind = Kind::none;
  double timeout_s = 0;                 ///< as set in the board (by `setup` or by its own utility)
  std::vector<double> safe_electrical;  ///< what each output goes to, in the outputs' unit
  Feed feed = Feed::any_request;
  std::vector<std::uint8_t> functions;
  std::optional<FixedWrite> feed_write;
  std::optional<Tripped> tripped;      ///< where the board says that it tripped
  std::vector<FixedWrite> clear;       ///< what ends the tripped state, in this order; empty: any write does
  std::optional<ClientCount> clients;  ///< where the board counts its clients, this program included

  /// True if requests of a client that only reads feed it, too.
  [[nodiscard]] bool fed_by_reading() const noexcept {
    constexpr std::uint8_t last_that_reads = 4;
    const bool reads = std::any_of(functions.begin(), functions.end(),
                                   [](std::uint8_t function) { return function <= last_that_reads; });
    return kind != Kind::none && (feed == Feed::any_request || (feed == Feed::functions && reads));
  }
};

/// A board file.
struct BoardMap {
  std::string name;
  std::string source;    ///< where its numbers come from, one line
  int address_base = 0;  ///< what the file calls the first register; for messages only
  WordOrder word_order = WordOrder::high_first;
  TerminalBlock inputs;
  TerminalBlock outputs;
  /// Most registers in one request; 125 is what the specification allows a read.
  std::uint16_t max_registers = 125;
  /// Function code 23 writes the outputs and reads the inputs in one transaction.
  bool has_fc23 = false;
  /// Registers between two blocks that may be read along to save a transaction; the board must serve them.
  std::uint16_t readable_gap = 0;
  std::optional<StatusBlock> input_status;
  std::optional<ReadBack> read_back;
  BoardWatchdog watchdog;
  /// Written, in this order, whenever a session was opened; to a board whose watchdog has tripped only after
  /// that was cleared.
  std::vector<FixedWrite> setup;

  [[nodiscard]] bool has_inputs() const noexcept { return inputs.registers.count > 0; }
  [[nodiscard]] bool has_outputs() const noexcept { return outputs.registers.count > 0; }
};

}  // namespace softgrip::drivers
