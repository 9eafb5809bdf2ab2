#pragma once
// Implements a board that consists of one or more Modbus modules on network hosts or a serial line. A board
// map describes each module.

#include <memory>
#include <string>
#include <vector>

#include "drivers/board/board.h"
#include "drivers/modbus/modbus_module.h"

namespace softgrip::drivers {

struct ModbusSettings {
  std::vector<ModbusAddress> links;
  std::vector<ModbusModuleSettings> modules;
  std::vector<ChannelWiring> wiring;  ///< wiring of the channels, one entry per channel; problems_of() must
                                      ///< be empty
  /// Largest number of reads per module with which connect() measures the round trips for budget(). The
  /// measurement takes at most about half of the time until the deadline of connect(). If the number is 0,
  /// connect() measures nothing, and budget() uses an assumed round trip.
  int probes = 9;
};

/// Returns the errors of the settings; see wiring_problems().
[[nodiscard]] std::vector<std::string> problems_of(const ModbusSettings& settings);

/// One exchange first writes the outputs of all modules, if possible with one write per module (function code
/// 16 or 23). After the writes, the exchange reads the inputs and the registers for status, read-back and
/// watchdog, with as few reads as possible. Because all writes precede the reads, a failure of a module
/// without outputs does not prevent the writes to the other modules. For the same reason, connect() succeeds
/// if all modules with outputs respond. The first exchange then writes the commands, and fails when it reads
/// from a module that did not respond to connect(). The complete exchange must end within `deadline`, also if
/// a reply arrives in parts. The time is measured with CLOCK_BOOTTIME. After a time-out, an error of the
/// connection or an unexpected reply, all links are closed. Therefore, a late or duplicated reply cannot be
/// taken for the response to a later request. exchange() then returns `disconnected` until connect() has
/// opened new links.
///
/// A tripped watchdog is cleared only in the first exchange after connect(). This exchange writes the
/// commands, clears the watchdog, writes the commands a second time and reads. If the watchdog trips after
/// this exchange, each exchange returns `watchdog_tripped` until the next connect().
class ModbusBoard final : public Board {
 public:
  explicit ModbusBoard(const ModbusSettings& settings);
  ~ModbusBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] const char* detail() const noexcept override;
  [[nodiscard]] double found_kpa(std::size_t channel) const noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] Budget budget() const override;
  /// Returns true if every module with outputs has a watchdog.
  [[nodiscard]] bool has_watchdog() const noexcept override;
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override;
  [[nodiscard]] bool fed_by_readers() const noexcept override;
  [[nodiscard]] unsigned clients() const noexcept override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::drivers
