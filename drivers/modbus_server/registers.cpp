#include "drivers/modbus_server/registers.h"

#include <modbus/modbus.h>

namespace softgrip::modbus {
namespace {

using drivers::max_fc23_write_registers;
using drivers::max_read_bits;
using drivers::max_read_registers;
using drivers::max_write_registers;

constexpr std::uint16_t coil_on = 0xff00;
constexpr std::uint8_t illegal_function = MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
constexpr std::uint8_t illegal_address = MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS;
constexpr std::uint8_t illegal_value = MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;

Registers::Answer refused(std::span<const std::uint8_t> pdu, std::uint8_t code) {
  return {exception_reply(pdu[0], code), false};
}

/// Returns the first five bytes of the request: function code, address, and value or quantity.
Registers::Answer echoed(std::span<const std::uint8_t> pdu) {
  return {Bytes(pdu.begin(), pdu.begin() + 5), true};
}

}  // namespace

Bytes exception_reply(std::uint8_t function, std::uint8_t code) {
  return {static_cast<std::uint8_t>(function | 0x80U), code};
}

void Registers::define_holding(std::uint16_t address, Access access, std::uint16_t value) {
  holding_[address] = {value, access};
}

void Registers::define_input(std::uint16_t address, std::uint16_t value) {
  input_[address] = value;
}

void Registers::define_coil(std::uint16_t address, bool value) {
  coils_[address] = value;
}

void Registers::define_discrete_input(std::uint16_t address, bool value) {
  discrete_inputs_[address] = value;
}

Registers::Answer Registers::answer(std::span<const std::uint8_t> pdu) {
  const std::uint8_t function = pdu[0];
  if (!functions_.contains(function)) return refused(pdu, illegal_function);
  switch (function) {
    case MODBUS_FC_READ_COILS:
      return read_bits(pdu, coils_);
    case MODBUS_FC_READ_DISCRETE_INPUTS:
      return read_bits(pdu, discrete_inputs_);
    case MODBUS_FC_READ_HOLDING_REGISTERS:
      return read_registers(pdu, true);
    case MODBUS_FC_READ_INPUT_REGISTERS:
      return read_registers(pdu, false);
    case MODBUS_FC_WRITE_SINGLE_COIL:
      return write_coil(pdu);
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return write_single(pdu);
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return write_multiple(pdu);
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return read_write(pdu);
  }
  return refused(pdu, illegal_function);
}

Registers::Answer Registers::read_registers(std::span<const std::uint8_t> pdu, bool holding) const {
  if (pdu.size() != 5) return refused(pdu, illegal_value);
  const std::uint16_t first = word_at(pdu, 1);
  const std::size_t count = word_at(pdu, 3);
  if (count < 1 || count > max_read_registers) return refused(pdu, illegal_value);
  Bytes reply{pdu[0], static_cast<std::uint8_t>(2 * count)};
  if (!append_values(reply, first, count, holding)) return refused(pdu, illegal_address);
  return {std::move(reply), false};
}

Registers::Answer Registers::read_bits(std::span<const std::uint8_t> pdu,
                                       const std::map<std::uint16_t, bool>& bits) {
  if (pdu.size() != 5) return refused(pdu, illegal_value);
  const std::uint16_t first = word_at(pdu, 1);
  const std::size_t count = word_at(pdu, 3);
  if (count < 1 || count > max_read_bits) return refused(pdu, illegal_value);
  Bytes reply{pdu[0], static_cast<std::uint8_t>((count + 7) / 8)};
  reply.resize(2 + (count + 7) / 8);
  for (std::size_t i = 0; i < count; ++i) {
    const auto bit = bits.find(static_cast<std::uint16_t>(first + i));
    if (first + i > 0xffff || bit == bits.end()) return refused(pdu, illegal_address);
    if (bit->second) reply[2 + i / 8] = static_cast<std::uint8_t>(reply[2 + i / 8] | 1U << i % 8);
  }
  return {std::move(reply), false};
}

Registers::Answer Registers::write_coil(std::span<const std::uint8_t> pdu) {
  if (pdu.size() != 5) return refused(pdu, illegal_value);
  const std::uint16_t value = word_at(pdu, 3);
  if (value != 0 && value != coil_on) return refused(pdu, illegal_value);
  const auto coil = coils_.find(word_at(pdu, 1));
  if (coil == coils_.end()) return refused(pdu, illegal_address);
  coil->second = value == coil_on;
  return echoed(pdu);
}

Registers::Answer Registers::write_single(std::span<const std::uint8_t> pdu) {
  if (pdu.size() != 5) return refused(pdu, illegal_value);
  const std::uint16_t address = word_at(pdu, 1);
  if (!writable(address, 1)) return refused(pdu, illegal_address);
  store(address, pdu.subspan(3));
  return echoed(pdu);
}

Registers::Answer Registers::write_multiple(std::span<const std::uint8_t> pdu) {
  if (pdu.size() < 6) return refused(pdu, illegal_value);
  const std::uint16_t first = word_at(pdu, 1);
  const std::size_t count = word_at(pdu, 3);
  if (count < 1 || count > max_write_registers || pdu[5] != 2 * count || pdu.size() != 6 + 2 * count) {
    return refused(pdu, illegal_value);
  }
  if (!writable(first, count)) return refused(pdu, illegal_address);
  store(first, pdu.subspan(6));
  return echoed(pdu);
}

Registers::Answer Registers::read_write(std::span<const std::uint8_t> pdu) {
  if (pdu.size() < 10) return refused(pdu, illegal_value);
  const std::uint16_t read_first = word_at(pdu, 1);
  const std::size_t read_count = word_at(pdu, 3);
  const std::uint16_t write_first = word_at(pdu, 5);
  const std::size_t write_count = word_at(pdu, 7);
  if (read_count < 1 || read_count > max_read_registers || write_count < 1 ||
      write_count > max_fc23_write_registers || pdu[9] != 2 * write_count ||
      pdu.size() != 10 + 2 * write_count) {
    return refused(pdu, illegal_value);
  }
  Bytes reply{pdu[0], static_cast<std::uint8_t>(2 * read_count)};
  if (!writable(write_first, write_count) || !append_values(reply, read_first, read_count, true)) {
    return refused(pdu, illegal_address);
  }
  // The specification requires that the write is executed before the read.
  store(write_first, pdu.subspan(10));
  reply.resize(2);
  append_values(reply, read_first, read_count, true);
  return {std::move(reply), true};
}

std::optional<std::uint16_t> Registers::value_of(std::size_t address, bool holding) const {
  if (address > 0xffff) return std::nullopt;
  const auto key = static_cast<std::uint16_t>(address);
  const auto held = holding_.find(key);
  const auto in = input_.find(key);
  const bool use_holding = held != holding_.end() && (holding || in == input_.end());
  if (use_holding) return held->second.value;
  if (in != input_.end()) return in->second;
  return std::nullopt;
}

bool Registers::writable(std::uint16_t first, std::size_t count) const {
  for (std::size_t address = first; address < first + count; ++address) {
    const auto found = address > 0xffff ? holding_.end() : holding_.find(static_cast<std::uint16_t>(address));
    if (found == holding_.end() || found->second.access != Access::read_write) return false;
  }
  return true;
}

bool Registers::append_values(Bytes& pdu, std::uint16_t first, std::size_t count, bool holding) const {
  for (std::size_t address = first; address < first + count; ++address) {
    const auto value = value_of(address, holding);
    if (!value) return false;
    append_word(pdu, *value);
  }
  return true;
}

void Registers::store(std::uint16_t first, std::span<const std::uint8_t> data) {
  for (std::size_t i = 0; i + 1 < data.size(); i += 2) {
    holding_.at(static_cast<std::uint16_t>(first + i / 2)).value = word_at(data, i);
  }
}

}  // namespace softgrip::modbus
