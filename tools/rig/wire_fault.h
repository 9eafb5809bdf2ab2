#pragma once
// What the faults of the wire make of a good reply.

#include "tools/rig/fault.h"
#include "tools/rig/mbap.h"
#include "tools/rig/reply.h"

namespace softgrip::tools::rig {

/// The reply as it should be: one piece, at once.
[[nodiscard]] Reply good_reply(const Request& request, const Bytes& pdu);

/// Whether the request is carried out while this fault of the wire is there.
[[nodiscard]] bool carried_out(FaultKind kind) noexcept;

/// What the client gets in place of good_reply(request, pdu).
[[nodiscard]] Reply spoiled_reply(const FaultSpec& fault, const Request& request, const Bytes& pdu);

}  // namespace softgrip::tools::rig
