#include "simulation/emulator/wire.h"

#include "simulation/emulator/rtu.h"

namespace softgrip::simulation {

Bytes frame_on(Wire wire, std::uint16_t transaction, std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  return wire == Wire::tcp ? frame(transaction, unit, pdu) : rtu_frame(unit, pdu);
}

}  // namespace softgrip::simulation
