#pragma once
// Modbus RTU on a serial line, or on a TCP connection to a serial server.

#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/rtu_frame.h"

namespace softgrip::drivers {

/// RTU has no transaction id: a response belongs to the request before it, and its bytes do not prove this.
/// Therefore a request is sent only after the silence of the specification. Bytes without a request end the
/// link, unless they are fewer than the shortest response. After a failure, a new link first listens as long
/// as a response may still take. libmodbus does none of this. It also does not find a response after stray
/// bytes, so this class receives without it.
class ModbusRtuFraming : public ModbusLink {
 protected:
  ModbusRtuFraming(_modbus* context, const LinkHabits& habits, bool on_network, Nanoseconds character,
                   Nanoseconds silence) noexcept
      : ModbusLink(context, habits, on_network), character_(character), silence_(silence) {}

  /// Called once a link is open. `usual`: response time of a module without bytes and silence.
  BusStatus listen(Nanoseconds usual, Nanoseconds deadline) noexcept;
  [[nodiscard]] Nanoseconds character() const noexcept { return character_; }
  [[nodiscard]] Nanoseconds silence() const noexcept { return silence_; }
  /// Returns the sizes of the last request and its response.
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

}  // namespace softgrip::drivers
