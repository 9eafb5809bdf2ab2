#pragma once
// Changes a good reply according to a fault of the wire.

#include "base/time.h"
#include "simulation/emulator/fault.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

/// Returns the reply without a fault: one piece, without delay.
[[nodiscard]] Reply good_reply(Wire wire, const Request& request, const Bytes& pdu);

/// Returns true if this fault of the wire affects a request that comes `connected_for` after its connection
/// was opened.
[[nodiscard]] bool touches(const FaultSpec& fault, const Request& request,
                           Nanoseconds connected_for) noexcept;

/// Returns true if the request is executed while this fault of the wire is active.
[[nodiscard]] bool carried_out(FaultKind kind) noexcept;

/// Returns the reply that the client receives instead of good_reply(wire, request, pdu). A frame on a serial
/// line has neither transaction id nor length. There, wrong_transaction is a wrong checksum, and wrong_length
/// adds five bytes (fewer would be stray bytes).
[[nodiscard]] Reply spoiled_reply(Wire wire, const FaultSpec& fault, const Request& request,
                                  const Bytes& pdu);

}  // namespace softgrip::simulation
