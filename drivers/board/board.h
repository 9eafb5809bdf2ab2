#pragma once
// The board interface: what the bus thread asks of any I/O board. N channels, one command each.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "model/reading.h"

namespace softgrip::drivers {

using model::Reading;

/// How one exchange with the board ended.
enum class BusStatus : std::uint8_t {
  ok,
  disconnected,      ///< no session; reconnect() is due
  timed_out,         ///< the transaction's own deadline passed
  bad_reply,         ///< wrong unit id, length, transaction id or function; the session is poisoned
  exception,         ///< the board answered with a Modbus exception
  write_refused,     ///< the read-back says that the output did not follow
  overwritten,       ///< the outputs are not what the last exchange left there: somebody else writes, too
  watchdog_tripped,  ///< the board's own watchdog holds the outputs at their safe value
  closed_at_once,    ///< the other end took the connection and closed it before its first answer
};
[[nodiscard]] const char* name_of(BusStatus status) noexcept;

/// An I/O board. All calls come from one thread (the bus thread; in virtual time the loop itself).
class Board {
 public:
  Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  Board(Board&&) = delete;
  Board& operator=(Board&&) = delete;
  virtual ~Board() = default;

  [[nodiscard]] virtual std::size_t channels() const noexcept = 0;

  /// Opens or reopens the session within `deadline`. May block up to then. Never called in a tick.
  /// The board's outputs are left as they are: the first exchange() writes the safe value.
  [[nodiscard]] virtual BusStatus connect(std::chrono::nanoseconds deadline) noexcept = 0;

  /// Writes one pressure per channel [kPa] and reads all channels back, within `deadline`.
  /// On anything but `ok` the readings are untouched. Allocates nothing.
  [[nodiscard]] virtual BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                           std::chrono::nanoseconds deadline) noexcept = 0;

  /// What connect() or exchange() last failed of, for the event log; valid until the next call of either.
  [[nodiscard]] virtual const char* detail() const noexcept { return ""; }

  /// Returns what a channel's output was in an exchange that ended with `write_refused` [kPa]. NaN if it was
  /// as written, or if the board did not say. Valid until the next exchange.
  [[nodiscard]] virtual double found_kpa(std::size_t /*channel*/) const noexcept {
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// One line for the start-up report: "ADAM-6024 at 127.0.0.1:502 unit 1".
  [[nodiscard]] virtual std::string describe() const = 0;

  /// The shortest period this board can be exchanged at [s] and how it adds up ("115200 8N1, FC23: 5.6 ms").
  struct Budget {
    double exchange_s = 0;
    std::string explanation;
  };
  [[nodiscard]] virtual Budget budget() const = 0;

  /// True if the outputs go to a safe value by themselves when the daemon stops talking.
  [[nodiscard]] virtual bool has_watchdog() const noexcept = 0;

  /// After so long without a request that feeds it, the first of its outputs goes to its safe value by
  /// itself; 0: none ever does.
  [[nodiscard]] virtual std::chrono::nanoseconds watchdog_time() const noexcept = 0;

  /// True if another client that only reads feeds the watchdog as well. Then the outputs keep their value
  /// after this program has ended, as long as the other client sends requests.
  [[nodiscard]] virtual bool fed_by_readers() const noexcept { return false; }

  /// Number of clients that the board counted in the last good exchange, this program included; 0: it does
  /// not count them.
  [[nodiscard]] virtual unsigned clients() const noexcept { return 0; }
};

}  // namespace softgrip::drivers
