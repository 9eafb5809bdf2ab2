#pragma once
// Implements Modbus RTU over a TCP connection to a serial server.

#include <span>
#include <string>

#include "drivers/modbus/modbus_rtu_framing.h"

namespace softgrip::drivers {

/// Link to the modules on the serial line of a serial server. The server may deliver a late response of one
/// connection into the next connection. Therefore, after a failure, the new connection first listens for late
/// responses, as a link on a serial line does.
class ModbusRtuTcpLink final : public ModbusRtuFraming {
 public:
  /// Creates a closed link. If the host is not a numeric address, open() fails and reports this.
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
