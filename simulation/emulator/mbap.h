#pragma once
// Modbus TCP framing: requests out of a byte stream, replies into frames. No sockets, no registers.
// Format: MODBUS Messaging on TCP/IP Implementation Guide V1.0b, 3.1.3 (MBAP header).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace softgrip::simulation {

using Bytes = std::vector<std::uint8_t>;

/// Transaction id, protocol id, length (two bytes each), unit id.
inline constexpr std::size_t mbap_header_size = 7;
/// Longest protocol data unit: 256 bytes of a serial frame less address and check.
inline constexpr std::size_t max_pdu_size = 253;

struct Request {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  Bytes pdu;  ///< function code and data, 1 to max_pdu_size bytes
};

/// Cuts the bytes of one connection into requests.
class RequestStream {
 public:
  void append(std::span<const std::uint8_t> bytes);
  /// The next complete request, or nothing. Throws away what it returned.
  [[nodiscard]] std::optional<Request> next();
  /// True once a header made no sense. The stream cannot be brought into step again: close the connection.
  [[nodiscard]] bool broken() const noexcept { return broken_; }

 private:
  Bytes pending_;
  bool broken_ = false;
};

/// A whole frame around a reply.
[[nodiscard]] Bytes frame(std::uint16_t transaction, std::uint8_t unit, std::span<const std::uint8_t> pdu);

/// Big-endian 16-bit words, as everything on this wire.
[[nodiscard]] constexpr std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t index) {
  return static_cast<std::uint16_t>(bytes[index] << 8U | bytes[index + 1]);
}
inline void append_word(Bytes& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xffU));
}

}  // namespace softgrip::simulation
