#pragma once
// Builds Modbus requests without framing: the bytes from the function code on. These bytes do not depend on
// the transmission (TCP or serial line).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace softgrip::drivers {

/// Longest request or response without its framing [bytes]: function code and 252 bytes of data.
inline constexpr std::size_t max_pdu = 253;
/// Largest size of a frame on TCP and on serial lines [bytes]. The frames of Modbus TCP are longer than those
/// of serial lines.
inline constexpr std::size_t max_frame = 7 + max_pdu;
using Frame = std::array<std::uint8_t, max_frame>;

/// Largest number of registers or bits that the specification allows in one transaction.
inline constexpr std::uint16_t max_read_registers = 125;
inline constexpr std::uint16_t max_read_bits = 2000;
inline constexpr std::uint16_t max_write_registers = 123;
inline constexpr std::uint16_t max_fc23_write_registers = 121;

/// One request. Function codes: 1 to 4 read, 5 and 6 write one value, 16 writes registers, 23 writes and
/// reads registers.
struct ModbusRequest {
  std::uint8_t function = 0;
  std::uint16_t address = 0;                   ///< address of the read; for function codes 5, 6 and 16 the
                                               ///< address of the write
  std::uint16_t count = 0;                     ///< number of bits or registers to read; not used by function
                                               ///< codes that only write
  std::uint16_t write_address = 0;             ///< for function code 23: address of the write
  std::span<const std::uint16_t> values = {};  ///< values to write; function code 5 has one value, and any
                                               ///< value except 0 means on
};

/// Sizes of a request and of its response [bytes]. The sizes include the function code, but not the framing.
struct TransactionSize {
  std::size_t request = 0;
  std::size_t reply = 0;
};

/// Returns the size of the reply to a request, including the function code [bytes]. Returns 0 for an invalid
/// request (unknown function code, too many registers, a count of 0).
[[nodiscard]] std::size_t reply_pdu_size(const ModbusRequest& request) noexcept;

/// Writes the bytes of a request to `pdu`. Returns the number of bytes; 0 for a request for which
/// reply_pdu_size() returns 0.
[[nodiscard]] std::size_t build_pdu(const ModbusRequest& request,
                                    std::span<std::uint8_t, max_pdu> pdu) noexcept;

/// Returns the sizes of a request and of its response.
[[nodiscard]] TransactionSize size_of(const ModbusRequest& request) noexcept;

}  // namespace softgrip::drivers
