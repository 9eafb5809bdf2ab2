#pragma once
// Builds and checks the frames of Modbus TCP, which consist of the MBAP header and a PDU. Source of the
// format: MODBUS Messaging on TCP/IP Implementation Guide V1.0b, 3.1.3.

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_message.h"

namespace softgrip::drivers {

/// Size of the MBAP header [bytes]. The header consists of transaction id, protocol id and length, with two
/// bytes each, and the unit id with one byte.
inline constexpr std::size_t mbap_size = 7;
inline constexpr std::size_t mbap_unit = 6;  ///< index of the unit id in the frame

/// Writes the MBAP header for the PDU (function code and data) that begins at frame[mbap_size] and has
/// `pdu_size` bytes. Returns the size of the frame.
std::size_t put_mbap(std::span<std::uint8_t> frame, std::size_t pdu_size, std::uint16_t transaction,
                     std::uint8_t unit) noexcept;

/// Writes the frame of a request. Returns the size of the frame; 0 for a request that reply_pdu_size()
/// refuses.
[[nodiscard]] std::size_t build_request(const ModbusRequest& request, std::uint16_t transaction,
                                        std::uint8_t unit, Frame& frame) noexcept;

/// Checks `bytes`, which are all bytes received since the request was sent. The state `incomplete` means that
/// `bytes` are a correct beginning of the response. Therefore, a wrong header is detected before the rest of
/// the response arrives.
[[nodiscard]] ModbusReply parse_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                                      std::uint16_t transaction, std::uint8_t unit) noexcept;

}  // namespace softgrip::drivers
