#pragma once
// Modbus RTU over a TCP connection to a serial server.

#include <span>
#include <string>

#include "drivers/modbus/modbus_rtu_framing.h"

namespace softgrip::drivers {

/// A serial server may deliver a late answer into the next connection. A connection after a failure therefore
/// listens first, as on a serial line.
class ModbusRtuTcpLink final : public ModbusRtuFraming {
 public:
  /// With a host that is no numeric address open() says so and fails.
  explicit ModbusRtuTcpLink(TcpAddress address);
  ~ModbusRtuTcpLink() override = default;

  [[nodiscard]] Board::Budget cost(std::span<const TransactionSize> transactions,
                                   const std::string& plan) const override;
  [[nodiscard]] std::string describe() const override;

 private:
  BusStatus connect(Nanoseconds deadline) noexcept override;
  BusStatus send(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept override;

  TcpAddress address_;
};

}  // namespace softgrip::drivers
