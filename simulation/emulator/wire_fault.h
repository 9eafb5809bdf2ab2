#pragma once
// Changes a correct reply according to a fault of the transmission.

#include "base/time.h"
#include "simulation/emulator/fault.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

/// Returns the correct reply, which is sent as one piece and without delay.
[[nodiscard]] Reply good_reply(Wire wire, const Request& request, const Bytes& pdu);

/// Returns true if this fault of the transmission affects a request. `connected_for` is the time from the
/// opening of the connection to the arrival of the request.
[[nodiscard]] bool touches(const FaultSpec& fault, const Request& request,
                           Nanoseconds connected_for) noexcept;

/// Returns true if a request is executed while this fault of the transmission is active.
[[nodiscard]] bool carried_out(FaultKind kind) noexcept;

/// Returns the reply that the client receives in place of good_reply(wire, request, pdu). A frame on a serial
/// line has neither a transaction id nor a length. Therefore, on a serial line, wrong_transaction causes a
/// wrong checksum, and wrong_length adds five bytes. Fewer than five extra bytes would be discarded as stray
/// bytes.
[[nodiscard]] Reply spoiled_reply(Wire wire, const FaultSpec& fault, const Request& request,
                                  const Bytes& pdu);

}  // namespace softgrip::simulation
