#pragma once
// Builds Modbus requests and checks responses without framing: the bytes from the function code on. These
// bytes do not depend on the transmission (TCP or serial line). A response comes from an untrusted source.
// The functions at the end of this file and in rtu_frame.h check the framing of the bytes. The texts of
// Modbus exceptions are provided without allocating memory.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace softgrip::drivers {

/// word_at() reads and put_word() writes a word of a byte buffer, high byte first. The caller must check that
/// the index `at + 1` is within the buffer.
[[nodiscard]] inline std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

inline void put_word(std::span<std::uint8_t> bytes, std::size_t at, std::uint16_t value) noexcept {
  bytes[at] = static_cast<std::uint8_t>(value >> 8);
  bytes[at + 1] = static_cast<std::uint8_t>(value & 0xff);
}

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

/// The reason why the received bytes are not the expected response.
enum class ReplyDefect : std::uint8_t {
  none,
  transaction,  ///< the bytes are the response to another request: a late or a duplicated reply
  protocol,     ///< the bytes are not a Modbus frame
  length,       ///< the length field in the header differs from the length of the expected response
  unit,         ///< the unit id in the response differs from that in the request
  function,     ///< the function code of the response differs from that of the request
  byte_count,   ///< the number of data bytes differs from the number that the request requires
  echo,         ///< the response confirms an address or a value that differs from the request
  trailing,     ///< more bytes have arrived than the response contains
  checksum,     ///< the checksum is wrong: bytes were changed in transmission (serial lines)
  own_echo,     ///< the received bytes are the request itself, because the line returns the sent bytes
                ///< (serial lines)
};
/// Returns a sentence about a defect for the event log.
[[nodiscard]] const char* text_of(ReplyDefect defect) noexcept;

/// Bit that marks the function code of an exception response, and size of an exception response without its
/// framing [bytes].
inline constexpr std::uint8_t exception_bit = 0x80;
inline constexpr std::size_t exception_pdu_size = 2;

struct ModbusReply {
  enum class State : std::uint8_t { incomplete, complete, exception, defective };
  State state = State::incomplete;
  ReplyDefect defect = ReplyDefect::none;
  std::uint8_t exception_code = 0;
  /// The data that a complete reply contains (bits or registers, high byte first); empty for a write. The
  /// span points into the bytes of the reply.
  std::span<const std::uint8_t> data = {};
};

/// Checks the received part of a reply, beginning with the function code. The state `incomplete` means that
/// the bytes are a correct beginning of the response. Therefore, a wrong byte is detected before the rest of
/// the response arrives. The states `complete` and `exception` refer to the first pdu_size_of(reply, request)
/// bytes. The functions that check the framing also check the bytes after these.
[[nodiscard]] ModbusReply parse_pdu(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept;

/// Returns the size of a reply [bytes]. The state of the reply must be `complete` or `exception`.
[[nodiscard]] std::size_t pdu_size_of(const ModbusReply& reply, const ModbusRequest& request) noexcept;

[[nodiscard]] inline bool is_answer(const ModbusReply& reply) noexcept {
  return reply.state == ModbusReply::State::complete || reply.state == ModbusReply::State::exception;
}

[[nodiscard]] inline ModbusReply defective(ReplyDefect defect) noexcept {
  return {.state = ModbusReply::State::defective, .defect = defect};
}

/// Returns the text of a Modbus exception.
[[nodiscard]] const char* text_of_exception(unsigned code) noexcept;

// The following functions build and check the frames of Modbus TCP, which consist of the MBAP header and a
// PDU. Source of the format: MODBUS Messaging on TCP/IP Implementation Guide V1.0b, 3.1.3.

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
