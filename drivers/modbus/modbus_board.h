#pragma once
// A board of one or more Modbus modules, each described by a board map, on network hosts or a serial line.

#include <memory>
#include <string>
#include <vector>

#include "drivers/board/board.h"
#include "drivers/modbus/modbus_module.h"

namespace softgrip::drivers {

struct ModbusSettings {
  std::vector<ModbusAddress> links;
  std::vector<ModbusModuleSettings> modules;
  std::vector<ChannelWiring> wiring;  ///< one per channel; problems_of() must be empty
  /// Largest number of reads per module with which connect() measures the round trips for budget(). The
  /// measurement takes at most about a quarter of the deadline. 0: no measurement, so budget() uses an
  /// assumed round trip.
  int probes = 9;
};

/// Returns the errors of the settings; see wiring_problems().
[[nodiscard]] std::vector<std::string> problems_of(const ModbusSettings& settings);

/// One exchange writes the outputs of all modules, if possible with one write per module (function code 16 or
/// 23). Then it reads the inputs and the status, read-back and watchdog registers of the maps with as few
/// reads as possible. All outputs are written before the reads, so that the failure of a module without
/// outputs does not prevent the writes to the others.
///
/// `deadline` limits the complete exchange on CLOCK_BOOTTIME, also if a reply arrives in parts. After a
/// time-out, an error of the connection or an unexpected reply, all links are closed. A late or duplicated
/// reply can therefore not be taken for the response to a later request. exchange() then returns
/// `disconnected` until connect() has opened new links.
///
/// A tripped watchdog is cleared only in the first exchange after connect(). This exchange writes the
/// commands, clears the watchdog, writes the commands again and reads. If the watchdog trips later, each
/// exchange returns `watchdog_tripped` until the next connect().
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
  /// Returns true if each module with outputs has a watchdog.
  [[nodiscard]] bool has_watchdog() const noexcept override;
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override;
  [[nodiscard]] bool fed_by_readers() const noexcept override;
  [[nodiscard]] unsigned clients() const noexcept override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::drivers
