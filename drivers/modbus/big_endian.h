#pragma once
// Reads and writes words in byte buffers. The high byte comes first, as in Modbus. The caller must check that
// the index `at + 1` is within the buffer.

#include <cstddef>
#include <cstdint>
#include <span>

namespace softgrip::drivers {

[[nodiscard]] inline std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

inline void put_word(std::span<std::uint8_t> bytes, std::size_t at, std::uint16_t value) noexcept {
  bytes[at] = static_cast<std::uint8_t>(value >> 8);
  bytes[at + 1] = static_cast<std::uint8_t>(value & 0xff);
}

}  // namespace softgrip::drivers
