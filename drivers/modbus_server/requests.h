#pragma once
// Divides the bytes of a connection or a serial line into requests, and puts replies into frames.
// Defines the bytes that a client receives, and the times at which the server sends these bytes. The emulator
// also uses these types to simulate transmission faults.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/modbus/modbus_message.h"

namespace softgrip::modbus {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;
using drivers::max_pdu;
using drivers::word_at;

/// The two types of transmission: Modbus TCP and Modbus RTU.
enum class Wire : std::uint8_t { tcp, rtu };

struct Request {
  std::uint16_t transaction = 0;  ///< transaction id; 0 on a serial line, which has no transaction ids
  std::uint8_t unit = 0;
  Bytes pdu;  ///< function code and data, 1 to max_pdu bytes
};

/// Divides the bytes of one connection into requests.
class RequestStream {
 public:
  void append(std::span<const std::uint8_t> bytes);
  /// Removes the next complete request from the waiting bytes and returns it. Returns nothing if no complete
  /// request has arrived.
  [[nodiscard]] std::optional<Request> next();
  /// Returns true if a request had an invalid header. The end of this request is unknown, so the connection
  /// must be closed.
  [[nodiscard]] bool broken() const noexcept { return broken_; }
  /// Returns true if the beginning of a request has arrived, but not its end.
  [[nodiscard]] bool half() const noexcept { return !pending_.empty(); }

 private:
  Bytes pending_;
  bool broken_ = false;
};

/// Divides the bytes of a serial line into requests. In the specification, a silence of 3.5 characters ends a
/// frame. On a busy machine, bytes arrive in groups, so silences are not reliable. Therefore, this class
/// determines the end of a frame from the length that the function code implies. Bytes that arrive after a
/// silence of more than 100 ms begin a new frame.
class RtuRequestStream {
 public:
  void append(std::span<const std::uint8_t> bytes, Clock::time_point now);
  /// Removes the next complete request from the waiting bytes and returns it. Returns nothing if no complete
  /// request has arrived. A frame with a wrong checksum is discarded together with all other waiting bytes,
  /// and the server does not respond to this frame.
  [[nodiscard]] std::optional<Request> next();

 private:
  Bytes pending_;
  Clock::time_point last_byte_;
};

/// Returns a complete frame with the PDU of a reply. `transaction` is used only for Modbus TCP.
[[nodiscard]] Bytes frame_on(Wire wire, std::uint16_t transaction, std::uint8_t unit,
                             std::span<const std::uint8_t> pdu);

inline void append_word(Bytes& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xffU));
}

/// Bytes of a reply that are sent when the time `after` has passed since the arrival of the request.
struct Piece {
  std::chrono::nanoseconds after{0};
  Bytes bytes;
};

/// The complete response to one request. If the board does not respond to the request, `pieces` is empty.
struct Reply {
  std::vector<Piece> pieces;
  bool disconnect = false;  ///< true: the connection is closed after all pieces are sent
};

}  // namespace softgrip::modbus
