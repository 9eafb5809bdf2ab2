#pragma once
// One TCP session with a Modbus server.

#include <cstdint>
#include <span>
#include <string>

#include "drivers/modbus/mbap.h"
#include "drivers/modbus/modbus_link.h"

namespace softgrip::drivers {

/// What libmodbus cannot do here is ours: to connect within a deadline to an IPv4 or IPv6 address, and to
/// number a question. Its raw request of version 3.1.6 always carries transaction id 0, by which a repeated
/// reply would pass for the answer to the next question. Where a gateway does not return the number
/// (TcpAddress::numbered) that danger is back: only an answer that comes before the next question is known.
class ModbusTcpLink final : public ModbusLink {
 public:
  /// With a host that is no numeric address open() says so and fails.
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
  /// Counts on across sessions: a gateway that delivers an old reply into a new session is found out too.
  std::uint16_t transaction_ = 0;
};

}  // namespace softgrip::drivers
