#pragma once
// Returns the settings of a board that consists of one Modbus module at an address of this computer.

#include <utility>

#include "drivers/modbus/modbus_board.h"

namespace softgrip::drivers::test {

inline ModbusSettings on_tcp(std::uint16_t port, BoardMap map, std::vector<ChannelWiring> wiring,
                             int probes = 9) {
  return {.links = {TcpAddress{.host = "127.0.0.1", .port = port}},
          .modules = {{.name = "board", .map = std::move(map), .unit = 1}},
          .wiring = std::move(wiring),
          .probes = probes};
}

}  // namespace softgrip::drivers::test
