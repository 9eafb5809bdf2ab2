#pragma once
// Modbus RTU framing on the side of the board: requests out of the bytes of a serial line. No descriptors.
// Format: MODBUS over Serial Line, Specification and Implementation Guide V1.02, 2.5.1.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "simulation/emulator/mbap.h"

namespace softgrip::simulation {

using Clock = std::chrono::steady_clock;

/// Cuts the bytes of a line into requests. The specification ends a frame by 3.5 characters of silence; on a
/// busy machine bytes arrive in lumps, so the length that each function has ends it here, and only a silence
/// that no lump explains throws away what was begun.
class RtuRequestStream {
 public:
  void append(std::span<const std::uint8_t> bytes, Clock::time_point now);
  /// The next complete request. What carries a wrong checksum is thrown away with all that came with it, as
  /// a board does that stays silent.
  [[nodiscard]] std::optional<Request> next();

 private:
  Bytes pending_;
  Clock::time_point last_byte_;
};

/// A whole frame around a reply.
[[nodiscard]] Bytes rtu_frame(std::uint8_t unit, std::span<const std::uint8_t> pdu);

}  // namespace softgrip::simulation
