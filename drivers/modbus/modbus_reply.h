#pragma once
// Checks if bytes from an untrusted source, beginning with the function code, are the Modbus response to a
// request. The functions have no state. mbap.h and rtu_frame.h check the framing.

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_request.h"

namespace softgrip::drivers {

/// The reason why bytes are not the expected response.
enum class ReplyDefect : std::uint8_t {
  none,
  transaction,  ///< response to another request: a late or a duplicated reply
  protocol,     ///< not Modbus
  length,       ///< the length in the header does not match the response
  unit,         ///< response of another unit
  function,     ///< another function code
  byte_count,   ///< the number of data bytes does not match the request
  echo,         ///< the write is confirmed with another address or value
  trailing,     ///< more bytes than the response has
  checksum,     ///< the bytes were changed in transmission (serial lines)
  own_echo,     ///< the received bytes are the request itself (serial lines)
};
/// Returns a sentence for the event log.
[[nodiscard]] const char* text_of(ReplyDefect defect) noexcept;

/// The bit that an exception sets in the function code, and the size of an exception without framing [bytes].
inline constexpr std::uint8_t exception_bit = 0x80;
inline constexpr std::size_t exception_pdu_size = 2;

struct ModbusReply {
  enum class State : std::uint8_t { incomplete, complete, exception, defective };
  State state = State::incomplete;
  ReplyDefect defect = ReplyDefect::none;
  std::uint8_t exception_code = 0;
  /// For a complete reply: the data that was read (bits or registers, high byte first); empty for writes.
  /// Points into the given bytes.
  std::span<const std::uint8_t> data = {};
};

/// Checks the bytes of a reply that have arrived so far, beginning with the function code. `incomplete` means
/// that they are a correct beginning of the response, so a wrong byte is detected before the rest arrives.
/// `complete` and `exception` apply to the first pdu_size_of(reply, request) bytes. The functions for the
/// framing check the bytes after them.
[[nodiscard]] ModbusReply parse_pdu(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept;

/// Returns the size of a reply that is complete or an exception [bytes].
[[nodiscard]] std::size_t pdu_size_of(const ModbusReply& reply, const ModbusRequest& request) noexcept;

[[nodiscard]] inline bool is_answer(const ModbusReply& reply) noexcept {
  return reply.state == ModbusReply::State::complete || reply.state == ModbusReply::State::exception;
}

[[nodiscard]] inline ModbusReply defective(ReplyDefect defect) noexcept {
  return {.state = ModbusReply::State::defective, .defect = defect};
}

}  // namespace softgrip::drivers
