#pragma once
// A serial line with Modbus RTU modules on it, one question at a time.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/serial_port.h"

namespace softgrip::drivers {

/// RTU has no transaction id: an answer belongs to the question before it, and nothing in it proves that. So
/// a question is only sent into a line that was silent for as long as the specification asks; bytes that come
/// while nothing was asked end the link; and after anything went wrong, open() listens for as long as an
/// answer that was under way could still take. libmodbus does none of this.
///
/// open() opens the device by its name, so that an adapter that was pulled out and put back is found again.
/// It allocates to look the name up, and refuses one that udev gave to several adapters.
class ModbusRtuLink final : public ModbusLink {
 public:
  explicit ModbusRtuLink(SerialLine line);
  ~ModbusRtuLink() override = default;

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
  [[nodiscard]] Nanoseconds answer_time(Nanoseconds round_trip) const noexcept override;

  BusStatus listen(Nanoseconds deadline) noexcept;
  BusStatus take_echo(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept;
  BusStatus read_some(std::span<std::uint8_t> bytes, const char* what, std::size_t& got) noexcept;

  SerialLine line_;
  Nanoseconds character_;
  Nanoseconds silence_;
  TransactionSize last_size_;
};

}  // namespace softgrip::drivers
