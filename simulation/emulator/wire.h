#pragma once
// The two wires that Modbus goes over here, and the frames on them.

#include <cstdint>
#include <span>

#include "simulation/emulator/mbap.h"

namespace softgrip::simulation {

enum class Wire : std::uint8_t { tcp, rtu };

/// A whole frame around a reply. A serial line has no transaction ids.
[[nodiscard]] Bytes frame_on(Wire wire, std::uint16_t transaction, std::uint8_t unit,
                             std::span<const std::uint8_t> pdu);

}  // namespace softgrip::simulation
