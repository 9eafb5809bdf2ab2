#pragma once
// Implements links to Modbus RTU modules: on a serial line of this computer, and on the serial line of a
// serial server to which a TCP connection leads.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/modbus/modbus_rtu_framing.h"
#include "drivers/modbus/serial_port.h"

namespace softgrip::drivers {

/// Link to the modules on a serial line. open() opens the device by its name. Therefore, open() also finds an
/// adapter that was unplugged and connected again. open() allocates memory for this search, and fails if udev
/// gave the name to several adapters.
class ModbusRtuLink final : public ModbusRtuFraming {
 public:
  explicit ModbusRtuLink(SerialLine line);
  ~ModbusRtuLink() override = default;

  [[nodiscard]] Board::Budget cost(std::span<const TransactionSize> transactions,
                                   const std::string& plan) const override;
  [[nodiscard]] std::string describe() const override;

 private:
  BusStatus connect(Nanoseconds deadline) noexcept override;
  BusStatus send(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept override;
  [[nodiscard]] Nanoseconds answer_time(Nanoseconds round_trip) const noexcept override;
  [[nodiscard]] Nanoseconds sending_time(std::size_t bytes) const noexcept override {
    return static_cast<Nanoseconds>(bytes) * character();
  }

  BusStatus take_echo(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept;

  SerialLine line_;
};

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
