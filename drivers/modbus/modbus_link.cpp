#include "drivers/modbus/modbus_link.h"

#include "drivers/modbus/modbus_rtu_link.h"
#include "drivers/modbus/modbus_tcp_link.h"

namespace softgrip::drivers {

std::unique_ptr<ModbusLink> make_link(const ModbusAddress& address) {
  if (const auto* tcp = std::get_if<TcpAddress>(&address)) return std::make_unique<ModbusTcpLink>(*tcp);
  return std::make_unique<ModbusRtuLink>(std::get<SerialLine>(address));
}

}  // namespace softgrip::drivers
