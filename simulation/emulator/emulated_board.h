#pragma once
// The board that the emulator pretends to be: registers as a board map describes them, converters, and the
// board's own watchdog. Knows terminals and their volts or milliamperes, nothing of what is wired to them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/board/board_map.h"
#include "model/reading.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

class EmulatedBoard {
 public:
  /// As after power-on: outputs at their safe values (0 where the map gives none), the watchdog asleep until
  /// the first request that feeds it.
  explicit EmulatedBoard(const drivers::BoardMap& map);

  [[nodiscard]] const drivers::BoardMap& map() const noexcept { return map_; }

  /// The answer to a request that arrives at `now`. Not before an earlier `now`.
  Registers::Answer answer(Nanoseconds now, std::span<const std::uint8_t> pdu);

  /// Lets the watchdog act if it is due by `now`.
  void advance(Nanoseconds now);
  /// When the watchdog trips unless it is fed; nothing while it sleeps, has tripped, or does not exist.
  [[nodiscard]] std::optional<Nanoseconds> watchdog_due() const noexcept;
  [[nodiscard]] bool tripped() const noexcept { return tripped_; }
  /// True once a client wrote an output.
  [[nodiscard]] bool commanded() const noexcept { return commanded_; }

  /// What an output terminal delivers [V or mA].
  [[nodiscard]] double output(std::size_t terminal) const { return outputs_.at(terminal); }
  /// Shows the number of connected clients, if the map has a register for it.
  void count_clients(std::size_t clients);
  /// While true, writes are answered as usual and have no effect.
  void ignore_writes(bool ignored) noexcept { writes_ignored_ = ignored; }

  /// What an input terminal receives [V or mA].
  void set_input(std::size_t terminal, double electrical);
  /// The board's own error value on an input, or its upper end where the map knows none.
  void set_input_error(std::size_t terminal);

 private:
  void define_registers();
  void define_block(const drivers::RegisterBlock& block, Registers::Access access);
  void define_write(const drivers::FixedWrite& write);
  void fill_readable_gaps();
  void allow_functions();
  [[nodiscard]] double raw_in(const drivers::RegisterBlock& block, std::size_t index) const;
  void put_raw(const drivers::RegisterBlock& block, std::size_t index, double raw);
  [[nodiscard]] bool feeds(std::span<const std::uint8_t> pdu);
  [[nodiscard]] bool is_heartbeat(std::span<const std::uint8_t> pdu);
  [[nodiscard]] bool is_write(std::span<const std::uint8_t> pdu, const drivers::FixedWrite& write) const;
  [[nodiscard]] bool touches_outputs(std::span<const std::uint8_t> pdu) const;
  void note_clearing(std::span<const std::uint8_t> pdu, bool wrote_outputs);
  void take_outputs();
  void show_outputs();
  void go_safe();
  void show_tripped();

  drivers::BoardMap map_;
  Registers registers_;
  std::vector<double> outputs_;  // V or mA
  Nanoseconds fed_at_ = 0;
  std::optional<bool> alternated_;  // the last write of the heartbeat had its second value
  bool watchdog_awake_ = false;
  bool tripped_ = false;
  bool commanded_ = false;
  bool writes_ignored_ = false;
  std::vector<bool> cleared_;  // which of the clearing writes came since the watchdog tripped
};

}  // namespace softgrip::simulation
