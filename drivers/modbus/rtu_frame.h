#pragma once
// Builds and checks the frames of Modbus RTU on serial lines. A frame consists of the unit id, the PDU
// (function code and data) and the CRC. A silence ends a frame. Source: MODBUS over Serial Line,
// Specification and Implementation Guide V1.02, 2.5.1.

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/modbus/modbus_message.h"

namespace softgrip::drivers {

/// Largest size of a frame on a serial line [bytes].
inline constexpr std::size_t max_rtu_frame = 1 + max_pdu + 2;
/// Size of the framing: unit id and CRC [bytes].
inline constexpr std::size_t rtu_overhead = 3;

/// Largest number of stray bytes that are discarded. The number is one byte smaller than the shortest
/// response, which is an exception response.
inline constexpr std::size_t max_stray_bytes = rtu_overhead + exception_pdu_size - 1;

/// Returns the CRC-16 of the Modbus specification: polynomial 0xA001 (reflected), start value 0xFFFF. A frame
/// contains the low byte of the CRC first.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept;

/// Adds the unit id and the CRC to a PDU that begins at frame[1] and has `pdu_size` bytes. Returns the size
/// of the frame.
std::size_t put_rtu_ends(std::span<std::uint8_t> frame, std::size_t pdu_size, std::uint8_t unit) noexcept;

/// Returns true if the frame ends with the CRC of the bytes before it.
[[nodiscard]] bool crc_holds(std::span<const std::uint8_t> frame) noexcept;

/// Writes the frame of a request. Returns the size of the frame; 0 for a request that reply_pdu_size()
/// refuses.
[[nodiscard]] std::size_t build_rtu_request(const ModbusRequest& request, std::uint8_t unit,
                                            Frame& frame) noexcept;

/// Checks `bytes`, which are all bytes received since the frame `asked` was sent. The state `incomplete`
/// means that `bytes` are a correct beginning of the response. Therefore, a wrong byte is detected before the
/// rest of the response arrives.
[[nodiscard]] ModbusReply parse_rtu_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                                          std::uint8_t unit, std::span<const std::uint8_t> asked) noexcept;

}  // namespace softgrip::drivers
