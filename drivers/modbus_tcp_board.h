#pragma once
// A board on Modbus TCP, described by a board map.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/board.h"
#include "drivers/board_map.h"
#include "drivers/channel_wiring.h"

namespace softgrip::drivers {

struct ModbusTcpSettings {
  std::string host;  ///< numeric address, IPv4 or IPv6; no name is resolved in the bus thread
  std::uint16_t port = 502;
  std::uint8_t unit = 1;  ///< unit id; replies with another one are refused
  BoardMap map;
  std::vector<ChannelWiring> wiring;  ///< one per channel; wiring_problems(map, wiring) is empty
  /// Most reads made by connect() to measure the round trip for budget(), in at most a quarter of its
  /// deadline; 0: none, the budget is assumed.
  int probes = 9;
};

/// One exchange is: the outputs in one write (or FC23), then the inputs, and with them what the map has of
/// status, read-back and watchdog registers, in as few reads as the map allows.
///
/// `deadline` spans the whole exchange on CLOCK_MONOTONIC; a reply that comes in drips does not extend it.
/// Any error but a Modbus exception closes the session, so that a late or duplicated reply can never be taken
/// for the answer to a later question: exchange() then returns `disconnected` until connect() made a new one.
///
/// A tripped watchdog is cleared only after connect(): the first exchange then writes the commands, clears,
/// writes the commands again and reads. Until then every exchange returns `watchdog_tripped`.
class ModbusTcpBoard final : public Board {
 public:
  explicit ModbusTcpBoard(const ModbusTcpSettings& settings);
  ~ModbusTcpBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] const char* detail() const noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] Budget budget() const override;
  [[nodiscard]] bool has_watchdog() const noexcept override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::drivers
