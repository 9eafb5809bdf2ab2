#pragma once
// What the faults of the wire make of a good reply.

#include "base/time.h"
#include "simulation/emulator/fault.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

/// The reply as it should be: one piece, at once.
[[nodiscard]] Reply good_reply(Wire wire, const Request& request, const Bytes& pdu);

/// Returns true if this fault of the wire affects a request that comes `connected_for` after its connection
/// was opened.
[[nodiscard]] bool touches(const FaultSpec& fault, const Request& request,
                           Nanoseconds connected_for) noexcept;

/// Whether the request is carried out while this fault of the wire is there.
[[nodiscard]] bool carried_out(FaultKind kind) noexcept;

/// What the client gets in place of good_reply(wire, request, pdu). A frame on a serial line has neither
/// transaction id nor length: there wrong_transaction is a wrong checksum, wrong_length five bytes too many:
/// fewer are stray bytes.
[[nodiscard]] Reply spoiled_reply(Wire wire, const FaultSpec& fault, const Request& request,
                                  const Bytes& pdu);

}  // namespace softgrip::simulation
