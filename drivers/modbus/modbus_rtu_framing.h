#pragma once
// Modbus RTU on a serial line, or on a TCP connection to a serial server.

#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/rtu_frame.h"

namespace softgrip::drivers {

/// RTU has no transaction id: an answer belongs to the question before it, and nothing in it proves that. So
/// a question is only sent into a line that was silent for as long as the specification asks; bytes that come
/// while nothing was asked end the link, unless they are fewer than any answer has; and after anything went
/// wrong, a new link listens for as long as an answer that was under way could still take. libmodbus does
/// none of this, and finds no answer behind stray bytes: here it does not receive.
class ModbusRtuFraming : public ModbusLink {
 protected:
  ModbusRtuFraming(_modbus* context, const LinkHabits& habits, bool on_network, Nanoseconds character,
                   Nanoseconds silence) noexcept
      : ModbusLink(context, habits, on_network), character_(character), silence_(silence) {}

  /// Called once a link is open. `usual`: response time of a module, beside bytes and silence.
  BusStatus listen(Nanoseconds usual, Nanoseconds deadline) noexcept;
  [[nodiscard]] Nanoseconds character() const noexcept { return character_; }
  [[nodiscard]] Nanoseconds silence() const noexcept { return silence_; }
  /// Sizes of the last request and its answer.
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
