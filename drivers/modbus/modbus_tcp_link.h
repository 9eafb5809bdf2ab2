#pragma once
// Implements a link over one TCP connection to a Modbus server.

#include <cstdint>
#include <span>
#include <string>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/modbus_message.h"

namespace softgrip::drivers {

/// Connects within a deadline to an IPv4 or IPv6 address, and gives each request its own transaction id. The
/// raw requests of libmodbus 3.1.6 always have the transaction id 0, so this class sets the id itself. If all
/// ids were equal, a repeated reply could be taken for the response to the next request. This risk remains
/// for a gateway that does not return the id (TcpAddress::numbered is false). The late responses of such a
/// gateway are detected only if they arrive before the next request is sent.
class ModbusTcpLink final : public ModbusLink {
 public:
  /// Creates a closed link. If the host is not a numeric address, open() fails and reports this.
  explicit ModbusTcpLink(TcpAddress address);
  ~ModbusTcpLink() override = default;

  [[nodiscard]] Board::Budget cost(std::span<const TransactionSize> transactions,
                                   const std::string& plan) const override;
  [[nodiscard]] std::string describe() const override;

 private:
  BusStatus connect(Nanoseconds deadline) noexcept override;
  std::size_t build(std::uint8_t unit, const ModbusRequest& request, Frame& frame) noexcept override;
  BusStatus before_asking(Nanoseconds deadline) noexcept override;
  BusStatus send(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept override;
  [[nodiscard]] ModbusReply judge(std::span<const std::uint8_t> bytes, std::uint8_t unit,
                                  const ModbusRequest& request,
                                  std::span<const std::uint8_t> asked) const noexcept override;
  [[nodiscard]] bool numbers_answers() const noexcept override { return address_.numbered; }
  [[nodiscard]] bool answers_previous(std::span<const std::uint8_t> bytes) const noexcept override;
  [[nodiscard]] std::size_t unit_place() const noexcept override { return mbap_unit; }

  TcpAddress address_;
  /// Last transaction id. Later connections continue with the next id. Therefore, an old reply that a gateway
  /// delivers into a new connection is detected.
  std::uint16_t transaction_ = 0;
};

}  // namespace softgrip::drivers
