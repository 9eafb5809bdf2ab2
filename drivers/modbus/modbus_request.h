#pragma once
// Builds Modbus requests without framing: the bytes from the function code on. They are the same for TCP and
// for serial lines.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace softgrip::drivers {

/// Longest request or response without its framing [bytes]: function code and 252 bytes of data.
inline constexpr std::size_t max_pdu = 253;
/// Longest frame on TCP and on serial lines [bytes]. The longest frames are the frames of Modbus TCP.
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
  std::uint16_t count = 0;                     ///< number of bits or registers to read; function codes that
                                               ///< only write do not use it
  std::uint16_t write_address = 0;             ///< for function code 23: address of the write
  std::span<const std::uint16_t> values = {};  ///< values to write; for function code 5 one value, where any
                                               ///< value except 0 means on
};

/// Sizes of a request and of its response [bytes]. They include the function code, but not the framing.
struct TransactionSize {
  std::size_t request = 0;
  std::size_t reply = 0;
};

/// Returns the size of the reply, including its function code [bytes]. Returns 0 for a request to which no
/// board can respond (unknown function, too many registers, a count of 0).
[[nodiscard]] std::size_t reply_pdu_size(const ModbusRequest& request) noexcept;

/// Writes the request. Returns the size of the request; 0 for a request that reply_pdu_size() refuses.
[[nodiscard]] std::size_t build_pdu(const ModbusRequest& request,
                                    std::span<std::uint8_t, max_pdu> pdu) noexcept;

/// Returns the sizes of the request and its response.
[[nodiscard]] TransactionSize size_of(const ModbusRequest& request) noexcept;

}  // namespace softgrip::drivers
