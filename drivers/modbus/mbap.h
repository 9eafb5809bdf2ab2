#pragma once
// Framing on Modbus TCP: the header in front of questions and answers.
// Format: MODBUS Messaging on TCP/IP Implementation Guide V1.0b, 3.1.3 (MBAP header).

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_reply.h"
#include "drivers/modbus/modbus_request.h"

namespace softgrip::drivers {

/// Transaction id, protocol id, length (two bytes each), unit id.
inline constexpr std::size_t mbap_size = 7;
inline constexpr std::size_t mbap_unit = 6;  ///< index of the unit id

/// Writes the header in front of the PDU of `pdu_size` bytes that begins at frame[mbap_size]; returns the
/// size of the frame.
std::size_t put_mbap(std::span<std::uint8_t> frame, std::size_t pdu_size, std::uint16_t transaction,
                     std::uint8_t unit) noexcept;

/// Writes the frame of a question; returns its size, or 0 for a request that reply_pdu_size() refuses.
[[nodiscard]] std::size_t build_request(const ModbusRequest& request, std::uint16_t transaction,
                                        std::uint8_t unit, Frame& frame) noexcept;

/// Judges `bytes`, all that was received since the question was sent. `incomplete` means that they are a
/// proper beginning of the answer. Every byte is judged as soon as it is there: a wrong header is not waited
/// out.
[[nodiscard]] ModbusReply parse_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                                      std::uint16_t transaction, std::uint8_t unit) noexcept;

}  // namespace softgrip::drivers
