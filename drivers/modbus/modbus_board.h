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
  /// Largest number of reads per link with which connect() measures it for budget(), within a quarter of its
  /// deadline; 0: no measurement, the budget is assumed.
  int probes = 9;
};

/// Returns the errors of the settings; see wiring_problems().
[[nodiscard]] std::vector<std::string> problems_of(const ModbusSettings& settings);

/// One exchange writes the outputs of all modules, each in one write if possible (or FC23). Then it reads the
/// inputs and the status, read-back and watchdog registers of the maps in the fewest reads. Outputs come
/// first, so that the failure of a module without outputs does not prevent writing the others.
///
/// `deadline` limits the complete exchange on CLOCK_BOOTTIME; a reply that arrives in parts does not extend
/// it. All errors except a Modbus exception close the links. A late or duplicated reply can then not be taken
/// for the response to a later request. exchange() returns `disconnected` until connect() has opened new
/// links.
///
/// A tripped watchdog is cleared only after connect(): the first exchange writes the commands, clears the
/// watchdog, writes the commands again and reads. Before that, each exchange returns `watchdog_tripped`.
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
