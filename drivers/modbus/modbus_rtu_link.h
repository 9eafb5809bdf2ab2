#pragma once
// Implements links to Modbus RTU modules: on a serial line of this computer, and on the serial line of a
// serial server to which a TCP connection leads. Both links have the Modbus RTU framing.

#include <cstdint>
#include <span>
#include <string>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/rtu_frame.h"
#include "drivers/modbus/serial_port.h"

namespace softgrip::drivers {

/// RTU has no transaction id, so the bytes of a response do not show to which request the response belongs.
/// Therefore, a request is sent only after the silence of the specification. Bytes that arrive before a
/// request are discarded if they are fewer than the bytes of the shortest response. Otherwise, the link is
/// closed. After a failure, a new link first listens for the time that a late response may take. libmodbus
/// has none of these functions. libmodbus also does not find a response that follows stray bytes. Therefore,
/// this class receives without libmodbus.
class ModbusRtuFraming : public ModbusLink {
 protected:
  ModbusRtuFraming(_modbus* context, const LinkHabits& habits, bool on_network, Nanoseconds character,
                   Nanoseconds silence) noexcept
      : ModbusLink(context, habits, on_network), character_(character), silence_(silence) {}

  /// Discards late responses after a link was opened. `usual` is the response time of a module, without the
  /// transmission time and without the silence [ns].
  BusStatus listen(Nanoseconds usual, Nanoseconds deadline) noexcept;
  [[nodiscard]] Nanoseconds character() const noexcept { return character_; }
  [[nodiscard]] Nanoseconds silence() const noexcept { return silence_; }
  /// Returns the sizes of the last request and of its response.
  [[nodiscard]] const TransactionSize& last_size() const noexcept { return last_size_; }

 private:
  std::size_t build(std::uint8_t unit, const ModbusRequest& request, Frame& frame) noexcept override;
  BusStatus before_asking(Nanoseconds deadline) noexcept override;
  Received hear(std::span<std::uint8_t> buffer, std::uint8_t unit, const ModbusRequest& request,
                std::span<const std::uint8_t> asked, Nanoseconds deadline) noexcept override;
  [[nodiscard]] ModbusReply judge(std::span<const std::uint8_t> bytes, std::uint8_t unit,
                                  const ModbusRequest& request,
                                  std::span<const std::uint8_t> asked) const noexcept override;
  [[nodiscard]] std::size_t most_stray() const noexcept override { return max_stray_bytes; }
  [[nodiscard]] std::size_t unit_place() const noexcept override { return 0; }

  Nanoseconds character_;
  Nanoseconds silence_;
  TransactionSize last_size_;
};

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
