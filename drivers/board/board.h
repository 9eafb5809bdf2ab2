#pragma once
// The interface between the bus thread and an I/O board. A board has N channels with one command each.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "model/reading.h"

namespace softgrip::drivers {

using model::Reading;

/// The result of an exchange with the board.
enum class BusStatus : std::uint8_t {
  ok,
  disconnected,      ///< there is no open session; connect() is necessary
  timed_out,         ///< the deadline passed before the exchange was complete
  bad_reply,         ///< the reply has a wrong unit id, length, transaction id or function; the session must
                     ///< be closed
  exception,         ///< the board responded with a Modbus exception
  write_refused,     ///< a command is invalid or out of range, or the read-back differs from the written
                     ///< value
  overwritten,       ///< another client has written to the board since the last exchange
  watchdog_tripped,  ///< the board's own watchdog holds the outputs at their safe value
  closed_at_once,    ///< the board, or a device before it, accepted the connection and closed it before the
                     ///< first response
};
[[nodiscard]] const char* name_of(BusStatus status) noexcept;

/// An I/O board. All functions are called from one thread: the bus thread, or the loop in virtual time.
class Board {
 public:
  Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  Board(Board&&) = delete;
  Board& operator=(Board&&) = delete;
  virtual ~Board() = default;

  [[nodiscard]] virtual std::size_t channels() const noexcept = 0;

  /// Opens or reopens the session within `deadline`, and may block for this time. It is never called in a
  /// tick. connect() does not change the outputs of the board; the first exchange() writes the safe value.
  [[nodiscard]] virtual BusStatus connect(std::chrono::nanoseconds deadline) noexcept = 0;

  /// Writes one pressure per channel [kPa] and reads all channels within `deadline`. If the result is not
  /// `ok`, the readings do not change. Does not allocate memory.
  [[nodiscard]] virtual BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                           std::chrono::nanoseconds deadline) noexcept = 0;

  /// Returns the reason why the last connect() or exchange() failed, for the event log. The text is valid
  /// until the next call of connect() or exchange().
  [[nodiscard]] virtual const char* detail() const noexcept { return ""; }

  /// Returns the output of a channel that the board reported in an exchange with the result `write_refused`
  /// [kPa]. Returns NaN if the output had the written value, or if the board does not report its outputs. The
  /// value is valid until the next exchange.
  [[nodiscard]] virtual double found_kpa(std::size_t /*channel*/) const noexcept {
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// Returns a description of the board in one line for the start-up report, such as "ADAM-6024 at
  /// 127.0.0.1:502 unit 1".
  [[nodiscard]] virtual std::string describe() const = 0;

  /// The shortest period of exchanges with this board [s], and the calculation of this period ("115200 8N1,
  /// FC23: 5.6 ms").
  struct Budget {
    double exchange_s = 0;
    std::string explanation;
  };
  [[nodiscard]] virtual Budget budget() const = 0;

  /// Returns true if the board sets its outputs to a safe value when the daemon stops sending requests.
  [[nodiscard]] virtual bool has_watchdog() const noexcept = 0;

  /// Returns the shortest time after which the board sets an output to its safe value if no request feeds the
  /// watchdog; 0 if the board has no watchdog.
  [[nodiscard]] virtual std::chrono::nanoseconds watchdog_time() const noexcept = 0;

  /// Returns true if another client that only reads also feeds the watchdog. In this case, the outputs keep
  /// their value after this program has ended, as long as the other client sends requests.
  [[nodiscard]] virtual bool fed_by_readers() const noexcept { return false; }

  /// Returns the number of clients that the board counted in the last successful exchange, including this
  /// program; 0 if the board does not count them.
  [[nodiscard]] virtual unsigned clients() const noexcept { return 0; }
};

}  // namespace softgrip::drivers
