#pragma once
// A board for tests. The board stores the values that the daemon writes. The test specifies the responses of
// the board.

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/clock.h"
#include "drivers/board/board.h"

namespace softgrip::daemon::testing {

class ScriptedBoard final : public drivers::Board {
 public:
  ScriptedBoard(std::size_t channels, const Clock& clock) : channels_(channels), clock_(clock) {}

  drivers::BusStatus next_connect = drivers::BusStatus::ok;
  drivers::BusStatus next_exchange = drivers::BusStatus::ok;
  std::vector<std::vector<double>> written;  ///< values that successful exchanges wrote, one element per
                                             ///< exchange
  std::chrono::nanoseconds watchdog{0};
  bool readers_feed = false;
  unsigned counted_clients = 0;
  const char* said = "scripted";
  double found =
      std::numeric_limits<double>::quiet_NaN();  ///< value that found_kpa() returns for every channel [kPa]
  std::function<void()> on_connect;              ///< function to call during each connect()
  std::function<void()> on_exchange;  ///< function to call before the request of an exchange reaches the
                                      ///< board
  std::vector<Nanoseconds> connect_attempts;  ///< times at which connect() was called

  [[nodiscard]] std::size_t channels() const noexcept override { return channels_; }
  [[nodiscard]] drivers::BusStatus connect(std::chrono::nanoseconds) noexcept override {
    connect_attempts.push_back(clock_.now());
    if (on_connect) on_connect();
    return next_connect;
  }
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<drivers::Reading> readings,
                                            std::chrono::nanoseconds) noexcept override {
    if (on_exchange) on_exchange();
    if (next_exchange != drivers::BusStatus::ok) return next_exchange;
    written.emplace_back(commands_kpa.begin(), commands_kpa.end());
    for (drivers::Reading& reading : readings) {
      reading.sampled_at = clock_.now();
      reading.validity = model::Validity::valid;
      ++reading.sequence;
    }
    return drivers::BusStatus::ok;
  }
  [[nodiscard]] const char* detail() const noexcept override { return said; }
  [[nodiscard]] double found_kpa(std::size_t) const noexcept override { return found; }
  [[nodiscard]] std::string describe() const override { return "scripted board"; }
  [[nodiscard]] Budget budget() const override { return {}; }
  [[nodiscard]] bool has_watchdog() const noexcept override { return watchdog.count() > 0; }
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override { return watchdog; }
  [[nodiscard]] bool fed_by_readers() const noexcept override { return readers_feed; }
  [[nodiscard]] unsigned clients() const noexcept override { return counted_clients; }

 private:
  std::size_t channels_;
  const Clock& clock_;
};

}  // namespace softgrip::daemon::testing
