#include "tools/rig/wire.h"

#include "tools/rig/rtu.h"

namespace softgrip::tools::rig {

Bytes frame_on(Wire wire, std::uint16_t transaction, std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  return wire == Wire::tcp ? frame(transaction, unit, pdu) : rtu_frame(unit, pdu);
}

}  // namespace softgrip::tools::rig
