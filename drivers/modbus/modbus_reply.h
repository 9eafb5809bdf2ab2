#pragma once
// Answers in Modbus: whether the bytes from the function code on are the answer to the question that was
// asked. Pure functions over bytes that nobody can trust; the framing around them is judged in mbap.h and
// rtu_frame.h.

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_request.h"

namespace softgrip::drivers {

/// Why bytes are not the answer.
enum class ReplyDefect : std::uint8_t {
  none,
  transaction,  ///< answers another question: a late or a duplicated reply
  protocol,     ///< not Modbus
  length,       ///< the header's length is not that of the answer
  unit,         ///< another unit answered
  function,     ///< another function
  byte_count,   ///< the count of data bytes contradicts the question
  echo,         ///< a write is confirmed with another address or value
  trailing,     ///< more bytes than the answer has
  checksum,     ///< the bytes were changed on the way (serial lines)
  own_echo,     ///< what came back is the question itself (serial lines)
};
/// A sentence for the event log.
[[nodiscard]] const char* text_of(ReplyDefect defect) noexcept;

/// In the function code of an answer that refuses; such an answer is so long, from the function code on.
inline constexpr std::uint8_t exception_bit = 0x80;
inline constexpr std::size_t exception_pdu_size = 2;

struct ModbusReply {
  enum class State : std::uint8_t { incomplete, complete, exception, defective };
  State state = State::incomplete;
  ReplyDefect defect = ReplyDefect::none;
  std::uint8_t exception_code = 0;
  /// Of a complete reply: what was read (bits or registers, high byte first); empty for writes. Points into
  /// the bytes that were given.
  std::span<const std::uint8_t> data = {};
};

/// Judges the beginning of a reply, from the function code on. `incomplete` means that it is a proper
/// beginning of the answer; every byte is judged as soon as it is there. Bytes behind the answer are for the
/// framing to judge: `complete` and `exception` look at the first pdu_size_of(reply, request) bytes.
[[nodiscard]] ModbusReply parse_pdu(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept;

/// Bytes of a reply that is complete or an exception.
[[nodiscard]] std::size_t pdu_size_of(const ModbusReply& reply, const ModbusRequest& request) noexcept;

[[nodiscard]] inline bool is_answer(const ModbusReply& reply) noexcept {
  return reply.state == ModbusReply::State::complete || reply.state == ModbusReply::State::exception;
}

[[nodiscard]] inline ModbusReply defective(ReplyDefect defect) noexcept {
  return {.state = ModbusReply::State::defective, .defect = defect};
}

}  // namespace softgrip::drivers
