#include "drivers/modbus/modbus_tcp_link.h"

#include <modbus/modbus.h>
#include <poll.h>

#include <utility>

namespace softgrip::drivers {

// libmodbus gets a socket that is already open. Therefore, libmodbus does not use the address in this
// context.
ModbusTcpLink::ModbusTcpLink(TcpAddress address)
    : ModbusLink(::modbus_new_tcp("127.0.0.1", 1), address.habits, true), address_(std::move(address)) {}

BusStatus ModbusTcpLink::connect(Nanoseconds deadline) noexcept {
  return connect_over_tcp(address_, deadline);
}

std::size_t ModbusTcpLink::build(std::uint8_t unit, const ModbusRequest& request, Frame& frame) noexcept {
  return build_request(request, ++transaction_, unit, frame);
}

/// Fails for a gateway without transaction ids if bytes of a late response have already arrived. After the
/// next request is sent, the late response would look like the response to this request.
BusStatus ModbusTcpLink::before_asking(Nanoseconds) noexcept {
  pollfd socket{.fd = descriptor(), .events = POLLIN, .revents = 0};
  if (address_.numbered || ::poll(&socket, 1, 0) == 0) return BusStatus::ok;
  std::array<std::uint8_t, 1> first{};
  std::size_t got = 0;
  const BusStatus status = read_some(first, "before asking", got);
  if (status != BusStatus::ok || got == 0) return status;
  return fail(BusStatus::bad_reply, "before asking", unasked);
}

BusStatus ModbusTcpLink::send(std::span<const std::uint8_t> frame, Nanoseconds) noexcept {
  return send_over_tcp(frame);
}

ModbusReply ModbusTcpLink::judge(std::span<const std::uint8_t> bytes, std::uint8_t unit,
                                 const ModbusRequest& request, std::span<const std::uint8_t>) const noexcept {
  const bool any = !address_.numbered && bytes.size() >= 2;
  return parse_reply(bytes, request, any ? word_at(bytes, 0) : transaction_, unit);
}

bool ModbusTcpLink::answers_previous(std::span<const std::uint8_t> bytes) const noexcept {
  return bytes.size() >= 2 && word_at(bytes, 0) == static_cast<std::uint16_t>(transaction_ - 1);
}

Board::Budget ModbusTcpLink::cost(std::span<const TransactionSize> transactions,
                                  const std::string& plan) const {
  return tcp_cost(transactions.size(), plan, address_.host, measured());
}

std::string ModbusTcpLink::describe() const {
  return address_.host + ":" + std::to_string(address_.port);
}

}  // namespace softgrip::drivers
