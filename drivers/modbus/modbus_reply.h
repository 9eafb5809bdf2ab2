#pragma once
// Checks if bytes from an untrusted source are the Modbus response to a request. The bytes begin with the
// function code. The functions in mbap.h and rtu_frame.h check the framing of these bytes.
// Provides the texts of Modbus exceptions without allocating memory.

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
  length,       ///< the length field in the header differs from the length of the expected response
  unit,         ///< the unit id in the response differs from that in the request
  function,     ///< the function code of the response differs from that of the request
  byte_count,   ///< the number of data bytes differs from the number that the request requires
  echo,         ///< the response confirms an address or a value that differs from the request
  trailing,     ///< more bytes have arrived than the response contains
  checksum,     ///< the checksum is wrong: bytes were changed in transmission (serial lines)
  own_echo,     ///< the received bytes are the request itself, because the line returns the sent bytes
                ///< (serial lines)
};
/// Returns a sentence about a defect for the event log.
[[nodiscard]] const char* text_of(ReplyDefect defect) noexcept;

/// Bit that marks the function code of an exception response, and size of an exception response without its
/// framing [bytes].
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

/// Checks the received part of a reply, beginning with the function code. The state `incomplete` means that
/// the bytes are a correct beginning of the response. Therefore, a wrong byte is detected before the rest of
/// the response arrives. The states `complete` and `exception` refer to the first pdu_size_of(reply, request)
/// bytes. The functions that check the framing also check the bytes after these.
[[nodiscard]] ModbusReply parse_pdu(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept;

/// Returns the size of a reply [bytes]. The state of the reply must be `complete` or `exception`.
[[nodiscard]] std::size_t pdu_size_of(const ModbusReply& reply, const ModbusRequest& request) noexcept;

[[nodiscard]] inline bool is_answer(const ModbusReply& reply) noexcept {
  return reply.state == ModbusReply::State::complete || reply.state == ModbusReply::State::exception;
}

[[nodiscard]] inline ModbusReply defective(ReplyDefect defect) noexcept {
  return {.state = ModbusReply::State::defective, .defect = defect};
}

/// Returns the text of a Modbus exception.
[[nodiscard]] const char* text_of_exception(unsigned code) noexcept;

}  // namespace softgrip::drivers
