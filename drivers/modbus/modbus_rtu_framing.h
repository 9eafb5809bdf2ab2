#pragma once
// Implements a link with Modbus RTU framing, on a serial line or on a TCP connection to a serial server.

#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/rtu_frame.h"

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

}  // namespace softgrip::drivers
