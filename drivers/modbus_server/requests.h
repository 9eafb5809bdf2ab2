#pragma once
// Requests out of the bytes of a connection or a line, and replies into frames. No descriptors, no registers.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/modbus/big_endian.h"
#include "drivers/modbus/modbus_request.h"

namespace softgrip::modbus {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;
using drivers::max_pdu;
using drivers::word_at;

/// The two wires that Modbus goes over here.
enum class Wire : std::uint8_t { tcp, rtu };

struct Request {
  std::uint16_t transaction = 0;  ///< 0 on a serial line, which has none
  std::uint8_t unit = 0;
  Bytes pdu;  ///< function code and data, 1 to max_pdu bytes
};

/// Cuts the bytes of one connection into requests.
class RequestStream {
 public:
  void append(std::span<const std::uint8_t> bytes);
  /// The next complete request, or nothing. Throws away what it returned.
  [[nodiscard]] std::optional<Request> next();
  /// True once a header made no sense. The stream cannot be brought into step again: close the connection.
  [[nodiscard]] bool broken() const noexcept { return broken_; }
  /// A request has begun to arrive, and its rest has not.
  [[nodiscard]] bool half() const noexcept { return !pending_.empty(); }

 private:
  Bytes pending_;
  bool broken_ = false;
};

/// Cuts the bytes of a serial line into requests. The specification ends a frame by 3.5 characters of
/// silence; on a busy machine bytes arrive in lumps, so the length that each function has ends it here, and
/// only a silence that no lump explains throws away what was begun.
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

/// A whole frame around a reply. A serial line has no transaction ids.
[[nodiscard]] Bytes frame_on(Wire wire, std::uint16_t transaction, std::uint8_t unit,
                             std::span<const std::uint8_t> pdu);

inline void append_word(Bytes& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xffU));
}

}  // namespace softgrip::modbus
