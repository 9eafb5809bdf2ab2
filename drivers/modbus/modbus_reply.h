#pragma once
// Checks if bytes from an untrusted source are the Modbus response to a request. The bytes begin with the
// function code. The functions have no state. mbap.h and rtu_frame.h check the framing.

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_request.h"

namespace softgrip::drivers {

/// The reason why the received bytes are not the expected response.
enum class ReplyDefect : std::uint8_t {
  none,
  transaction,  ///< the bytes are the response to another request: a late or a duplicated reply
  protocol,     ///< the bytes are not a Modbus frame
  length,       ///< the length in the header differs from the length of the expected response
  unit,         ///< the response comes from another unit
  function,     ///< the response has another function code than the request
  byte_count,   ///< the number of data bytes differs from the number that the request requires
  echo,         ///< the response confirms another address or value than the request contains
  trailing,     ///< there are more bytes than the response has
  checksum,     ///< the checksum is wrong: bytes were changed in transmission (serial lines)
  own_echo,     ///< the received bytes are the request itself, which the line returned (serial lines)
};
/// Returns a sentence about a defect for the event log.
[[nodiscard]] const char* text_of(ReplyDefect defect) noexcept;

/// Bit that is added to the function code of an exception, and size of an exception without its framing
/// [bytes].
inline constexpr std::uint8_t exception_bit = 0x80;
inline constexpr std::size_t exception_pdu_size = 2;

struct ModbusReply {
  enum class State : std::uint8_t { incomplete, complete, exception, defective };
  State state = State::incomplete;
  ReplyDefect defect = ReplyDefect::none;
  std::uint8_t exception_code = 0;
  /// The data that a complete reply contains (bits or registers, high byte first); empty for a write. The
  /// span points into the bytes of the reply.
  std::span<const std::uint8_t> data = {};
};

/// Checks the bytes of a reply that have arrived so far, beginning with the function code. `incomplete` means
/// that the bytes are a correct beginning of the response. Therefore, a wrong byte is detected before the
/// rest of the response arrives. `complete` and `exception` apply to the first pdu_size_of(reply, request)
/// bytes. The functions for the framing check the bytes after these.
[[nodiscard]] ModbusReply parse_pdu(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept;

/// Returns the size of a reply whose state is `complete` or `exception` [bytes].
[[nodiscard]] std::size_t pdu_size_of(const ModbusReply& reply, const ModbusRequest& request) noexcept;

[[nodiscard]] inline bool is_answer(const ModbusReply& reply) noexcept {
  return reply.state == ModbusReply::State::complete || reply.state == ModbusReply::State::exception;
}

[[nodiscard]] inline ModbusReply defective(ReplyDefect defect) noexcept {
  return {.state = ModbusReply::State::defective, .defect = defect};
}

}  // namespace softgrip::drivers
