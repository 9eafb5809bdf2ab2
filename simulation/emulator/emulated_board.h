#pragma once
// Emulates a board: its registers according to a board map, its converters and its watchdog. The signals at
// the terminals of the board are voltages or currents. Valves and sensors are not part of this class.

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
  /// Creates the board in the state after power-on. The outputs have their safe values, or 0 if the board map
  /// gives no safe values. The watchdog is inactive until the first request that feeds it.
  explicit EmulatedBoard(const drivers::BoardMap& map);

  [[nodiscard]] const drivers::BoardMap& map() const noexcept { return map_; }

  /// Returns the reply to a request that arrives at the time `now`. `now` must not decrease from call to
  /// call.
  Registers::Answer answer(Nanoseconds now, std::span<const std::uint8_t> pdu);

  /// Trips the watchdog if its time-out has passed at the time `now`.
  void advance(Nanoseconds now);
  /// Returns the time at which the watchdog trips if no further request feeds it. Returns nullopt if the
  /// watchdog is inactive or has tripped, or if the board has no watchdog.
  [[nodiscard]] std::optional<Nanoseconds> watchdog_due() const noexcept;
  [[nodiscard]] bool tripped() const noexcept { return tripped_; }
  /// Returns true if a client has written an output since the board was created.
  [[nodiscard]] bool commanded() const noexcept { return commanded_; }

  /// Returns the signal of an output terminal [V, mA or kPa].
  [[nodiscard]] double output(std::size_t terminal) const { return outputs_.at(terminal); }
  /// Writes the number of connected clients to the register that the map defines for this number. Has no
  /// effect if the map defines no such register.
  void count_clients(std::size_t clients);
  /// Sets how the board handles writes. If `ignored` is true, the board confirms writes but does not execute
  /// them.
  void ignore_writes(bool ignored) noexcept { writes_ignored_ = ignored; }

  /// Sets the signal at an input terminal [V, mA or kPa].
  void set_input(std::size_t terminal, double electrical);
  /// Sets an input to the error value of the board. If the map gives no error value, sets the input to the
  /// upper end of the input's range.
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
  std::vector<double> outputs_;  // signals of the output terminals [V, mA or kPa]
  Nanoseconds fed_at_ = 0;
  std::optional<bool> alternated_;  // true: the last write of the heartbeat had the second of the two
                                    // alternating values
  bool watchdog_awake_ = false;
  bool tripped_ = false;
  bool commanded_ = false;
  bool writes_ignored_ = false;
  std::vector<bool> cleared_;  // for each write that clears the watchdog: true if this write was received
                               // after the watchdog tripped
};

}  // namespace softgrip::simulation
