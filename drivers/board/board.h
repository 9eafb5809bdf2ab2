#pragma once
// Defines the interface between the bus thread and an I/O board. A board has N channels with one pressure
// command each.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "base/enum_table.h"
#include "model/reading.h"

namespace softgrip::drivers {

using model::Reading;

/// The result of an exchange with the board.
enum class BusStatus : std::uint8_t {
  ok,
  disconnected,  ///< no connection to the board is open, or the connection was lost; connect() must be called
                 ///< next
  timed_out,     ///< the deadline passed before the exchange with the board was complete
  bad_reply,     ///< the reply has an unexpected unit id, length, transaction id or function code; the
                 ///< session must be closed
  exception,     ///< the board responded with a Modbus exception
  write_refused,     ///< a command is invalid or out of range, or the read-back differs from the written
                     ///< value
  overwritten,       ///< another client has written to the outputs since the last exchange
  watchdog_tripped,  ///< the watchdog of the board has set the outputs to their safe value and holds this
                     ///< value
  closed_at_once,    ///< the board, or a gateway in front of the board, accepted the connection and closed it
                     ///< before the first response
};
/// Returns the name of a result: "ok", "disconnected", "timed_out" ...
[[nodiscard]] inline std::string_view name_of(BusStatus status) noexcept {
  static constexpr auto names = enum_names<BusStatus>({{BusStatus::ok, "ok"},
                                                       {BusStatus::disconnected, "disconnected"},
                                                       {BusStatus::timed_out, "timed_out"},
                                                       {BusStatus::bad_reply, "bad_reply"},
                                                       {BusStatus::exception, "exception"},
                                                       {BusStatus::write_refused, "write_refused"},
                                                       {BusStatus::overwritten, "overwritten"},
                                                       {BusStatus::watchdog_tripped, "watchdog_tripped"},
                                                       {BusStatus::closed_at_once, "closed_at_once"}});
  return names[status];
}

/// An I/O board. One thread calls all functions: the bus thread, or the control loop in virtual time.
class Board {
 public:
  Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  Board(Board&&) = delete;
  Board& operator=(Board&&) = delete;
  virtual ~Board() = default;

  [[nodiscard]] virtual std::size_t channels() const noexcept = 0;

  /// Opens or reopens the session within `deadline`, and may block until `deadline`. The control loop never
  /// calls connect() in a tick. connect() does not change the outputs of the board; the first exchange()
  /// writes the safe value.
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

  /// Returns the shortest time without requests after which the watchdog of the board sets an output to its
  /// safe value; 0 if the board has no watchdog.
  [[nodiscard]] virtual std::chrono::nanoseconds watchdog_time() const noexcept = 0;

  /// Returns true if the read requests of another client also feed the watchdog, so that the watchdog does
  /// not trip. In this case, the outputs keep their value after this program has ended, as long as the other
  /// client sends requests.
  [[nodiscard]] virtual bool fed_by_readers() const noexcept { return false; }

  /// Returns the number of clients that the board counted in the last successful exchange, including this
  /// program; 0 if the board does not count clients.
  [[nodiscard]] virtual unsigned clients() const noexcept { return 0; }
};

}  // namespace softgrip::drivers
