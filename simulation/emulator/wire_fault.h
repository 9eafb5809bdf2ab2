#pragma once
// Changes a correct reply according to a fault of the wire.

#include "base/time.h"
#include "simulation/emulator/fault.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

/// Returns the correct reply, which is sent in one piece and without delay.
[[nodiscard]] Reply good_reply(Wire wire, const Request& request, const Bytes& pdu);

/// Returns true if this fault of the wire affects a request that comes `connected_for` after its connection
/// was opened.
[[nodiscard]] bool touches(const FaultSpec& fault, const Request& request,
                           Nanoseconds connected_for) noexcept;

/// Returns true if the request is executed while this fault of the wire is active.
[[nodiscard]] bool carried_out(FaultKind kind) noexcept;

/// Returns the reply that the client receives instead of good_reply(wire, request, pdu). A frame on a serial
/// line has neither transaction id nor length. On a serial line, wrong_transaction therefore causes a wrong
/// checksum, and wrong_length adds five bytes. Fewer bytes would be discarded as stray bytes.
[[nodiscard]] Reply spoiled_reply(Wire wire, const FaultSpec& fault, const Request& request,
                                  const Bytes& pdu);

}  // namespace softgrip::simulation
