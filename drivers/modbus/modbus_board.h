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
  std::vector<ChannelWiring> wiring;  ///< one per channel; problems_of() finds nothing
  /// Most reads of each link made by connect() to measure it for budget(), all in at most a quarter of its
  /// deadline; 0: none, the budget is assumed.
  int probes = 9;
};

/// What does not fit together; see wiring_problems().
[[nodiscard]] std::vector<std::string> problems_of(const ModbusSettings& settings);

/// One exchange is: the outputs of all modules, each in one write where it can be (or FC23), then the inputs,
/// and with them what the maps have of status, read-back and watchdog registers, in as few reads as the maps
/// allow. Outputs come first, so that a module without outputs that fails does not keep the others' from
/// them.
///
/// `deadline` spans the whole exchange on CLOCK_BOOTTIME; a reply that comes in drips does not extend it.
/// Any error but a Modbus exception closes the links, so that a late or duplicated reply can never be taken
/// for the answer to a later question: exchange() then returns `disconnected` until connect() made new ones.
///
/// A tripped watchdog is cleared only after connect(): the first exchange then writes the commands, clears,
/// writes the commands again and reads. Until then every exchange returns `watchdog_tripped`.
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
  /// True if every module that drives outputs has one.
  [[nodiscard]] bool has_watchdog() const noexcept override;
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override;
  [[nodiscard]] bool fed_by_readers() const noexcept override;
  [[nodiscard]] unsigned clients() const noexcept override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::drivers
