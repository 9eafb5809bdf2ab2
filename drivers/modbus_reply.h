#pragma once
// Answers on Modbus TCP: whether the bytes that came in are the answer to the question that was asked.
// Pure functions over bytes that nobody can trust: a small file of its own, to be fuzzed.

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus_request.h"

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
};
/// A sentence for the event log.
[[nodiscard]] const char* text_of(ReplyDefect defect) noexcept;

struct ModbusReply {
  enum class State : std::uint8_t { incomplete, complete, exception, defective };
  State state = State::incomplete;
  ReplyDefect defect = ReplyDefect::none;
  std::uint8_t exception_code = 0;
  /// Of a complete reply: what was read (bits or registers, high byte first); empty for writes. Points into
  /// the bytes that were given.
  std::span<const std::uint8_t> data = {};
};

/// Judges `bytes`, all that was received since the question was sent. `incomplete` means that they are a
/// proper beginning of the answer. Every byte is judged as soon as it is there: a wrong header is not waited
/// out.
[[nodiscard]] ModbusReply parse_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                                      std::uint16_t transaction, std::uint8_t unit) noexcept;

}  // namespace softgrip::drivers
