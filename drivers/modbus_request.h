#pragma once
// Questions on Modbus TCP: building the bytes that go out.
//
// Why libmodbus does not frame them: its client sends and receives in one call, so that the unit id and the
// length of a reply, which 3.1.6 does not check, cannot be looked at before it acts on them; and its raw
// request always carries transaction id 0, so that a late reply could pass for the answer to a later
// question. What is left of it here are its constants and its texts of exceptions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace softgrip::drivers {

/// Longest frame on Modbus TCP [bytes]: MBAP header, function, 252 bytes of data.
inline constexpr std::size_t max_frame = 260;
using Frame = std::array<std::uint8_t, max_frame>;

/// Most registers or bits in one transaction, by the specification.
inline constexpr std::uint16_t max_read_registers = 125;
inline constexpr std::uint16_t max_read_bits = 2000;
inline constexpr std::uint16_t max_write_registers = 123;
inline constexpr std::uint16_t max_fc23_write_registers = 121;

/// One question. Functions: 1-4 read, 5 and 6 write one, 16 writes registers, 23 writes and reads registers.
struct ModbusRequest {
  std::uint8_t function = 0;
  std::uint16_t address = 0;                   ///< of what is read; for 5, 6 and 16 of what is written
  std::uint16_t count = 0;                     ///< bits or registers to be read
  std::uint16_t write_address = 0;             ///< for 23
  std::span<const std::uint16_t> values = {};  ///< to be written; for 5 one value, not 0 meaning on
};

/// Bytes after the unit id of the reply that is due, function code included; 0 for a request that no board
/// can answer (unknown function, too many registers, a count of nothing).
[[nodiscard]] std::size_t reply_pdu_size(const ModbusRequest& request) noexcept;

/// Writes the frame; returns its size, or 0 for a request that reply_pdu_size() refuses.
[[nodiscard]] std::size_t build_request(const ModbusRequest& request, std::uint16_t transaction,
                                        std::uint8_t unit, Frame& frame) noexcept;

}  // namespace softgrip::drivers
