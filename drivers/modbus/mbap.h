#pragma once
// Framing on Modbus TCP: the header in front of questions and answers.
//
// Why libmodbus does not frame them: its client sends and receives in one call, so that the unit id and the
// length of a reply, which 3.1.6 does not check, cannot be looked at before it acts on them; and its raw
// request always carries transaction id 0, so that a late reply could pass for the answer to a later
// question. What is left of it here are its constants and its texts of exceptions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_reply.h"
#include "drivers/modbus/modbus_request.h"

namespace softgrip::drivers {

/// Longest frame on Modbus TCP [bytes].
inline constexpr std::size_t max_frame = 7 + max_pdu;
using Frame = std::array<std::uint8_t, max_frame>;

/// Writes the frame; returns its size, or 0 for a request that reply_pdu_size() refuses.
[[nodiscard]] std::size_t build_request(const ModbusRequest& request, std::uint16_t transaction,
                                        std::uint8_t unit, Frame& frame) noexcept;

/// Judges `bytes`, all that was received since the question was sent. `incomplete` means that they are a
/// proper beginning of the answer. Every byte is judged as soon as it is there: a wrong header is not waited
/// out.
[[nodiscard]] ModbusReply parse_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                                      std::uint16_t transaction, std::uint8_t unit) noexcept;

}  // namespace softgrip::drivers
