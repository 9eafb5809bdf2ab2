#pragma once
// Questions in Modbus: the bytes from the function code on, whatever wire they go over.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace softgrip::drivers {

/// Longest question or answer without its framing [bytes]: function code and 252 bytes of data.
inline constexpr std::size_t max_pdu = 253;
/// Longest frame of any wire [bytes]: that of Modbus TCP.
inline constexpr std::size_t max_frame = 7 + max_pdu;
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

/// Bytes of a question and of its answer, function codes included, without framing.
struct TransactionSize {
  std::size_t request = 0;
  std::size_t reply = 0;
};

/// Bytes of the reply that is due, function code included; 0 for a request that no board can answer (unknown
/// function, too many registers, a count of nothing).
[[nodiscard]] std::size_t reply_pdu_size(const ModbusRequest& request) noexcept;

/// Writes the question; returns its size, or 0 for a request that reply_pdu_size() refuses.
[[nodiscard]] std::size_t build_pdu(const ModbusRequest& request,
                                    std::span<std::uint8_t, max_pdu> pdu) noexcept;

/// What both will take on the wire.
[[nodiscard]] TransactionSize size_of(const ModbusRequest& request) noexcept;

}  // namespace softgrip::drivers
