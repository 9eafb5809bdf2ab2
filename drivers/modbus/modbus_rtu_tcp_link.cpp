#include "drivers/modbus/modbus_rtu_tcp_link.h"

#include <modbus/modbus.h>

#include <utility>

#include "base/text.h"
#include "base/time.h"
#include "drivers/modbus/tcp_socket.h"

namespace softgrip::drivers {
namespace {

/// Assumed duration of a character on the serial line at 9600 baud [ns]. The actual baud rate is unknown.
constexpr Nanoseconds slow_character = 1'041'667;

}  // namespace

// libmodbus gets a socket that is already open. Therefore, libmodbus never opens the device "/dev/null" of
// this context.
ModbusRtuTcpLink::ModbusRtuTcpLink(TcpAddress address)
    : ModbusRtuFraming(::modbus_new_rtu("/dev/null", 9600, 'N', 8, 1), address.habits, true, slow_character,
                       nanoseconds(address.silence_s)),
      address_(std::move(address)) {}

BusStatus ModbusRtuTcpLink::connect(Nanoseconds deadline) noexcept {
  TcpConnection made = connect_tcp(address_, deadline);
  if (!made.socket) return refuse(made.status, "connecting", made.why);
  ::modbus_set_socket(context(), made.socket.release());
  return listen(0, deadline);
}

BusStatus ModbusRtuTcpLink::send(std::span<const std::uint8_t> frame, Nanoseconds) noexcept {
  const int error = send_whole(descriptor(), frame);
  if (error == 0) return BusStatus::ok;
  return is_closed(error) ? ended("sending") : fail(BusStatus::disconnected, "sending", text_of_errno(error));
}

Board::Budget ModbusRtuTcpLink::cost(std::span<const TransactionSize> transactions,
                                     const std::string& plan) const {
  Board::Budget cost = tcp_cost(transactions.size(), plan, address_.host, measured());
  const double silences_s = static_cast<double>(transactions.size()) * address_.silence_s;
  cost.exchange_s += silences_s;
  cost.explanation += ", RTU frames: the silences between frames take " + milliseconds(silences_s);
  return cost;
}

std::string ModbusRtuTcpLink::describe() const {
  return address_.host + ":" + std::to_string(address_.port) + " (RTU frames)";
}

}  // namespace softgrip::drivers
