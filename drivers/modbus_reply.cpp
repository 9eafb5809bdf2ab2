#include "drivers/modbus_reply.h"

#include <modbus/modbus.h>

#include "drivers/big_endian.h"

namespace softgrip::drivers {
namespace {

constexpr std::size_t header_size = 7;     // transaction, protocol, length, unit
constexpr std::size_t outside_length = 6;  // what the length field does not count
constexpr std::uint8_t exception_bit = 0x80;
constexpr std::size_t exception_pdu_size = 2;

ModbusReply defective(ReplyDefect defect) noexcept {
  return {.state = ModbusReply::State::defective, .defect = defect};
}

bool reads(std::uint8_t function) noexcept {
  return function <= MODBUS_FC_READ_INPUT_REGISTERS || function == MODBUS_FC_WRITE_AND_READ_REGISTERS;
}

/// The defect of the header, as far as `bytes` reach.
ReplyDefect header_defect(std::span<const std::uint8_t> bytes, std::size_t pdu_size,
                          std::uint16_t transaction, std::uint8_t unit) noexcept {
  if (bytes.size() >= 2 && word_at(bytes, 0) != transaction) return ReplyDefect::transaction;
  if (bytes.size() >= 4 && word_at(bytes, 2) != 0) return ReplyDefect::protocol;
  if (bytes.size() >= 6) {
    const std::size_t length = word_at(bytes, 4);
    if (length != 1 + pdu_size && length != 1 + exception_pdu_size) return ReplyDefect::length;
  }
  if (bytes.size() >= header_size && bytes[6] != unit) return ReplyDefect::unit;
  return ReplyDefect::none;
}

/// A write is confirmed by its address and its value, or the number of its values.
bool echoes(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept {
  std::uint16_t value = 0;
  switch (request.function) {
    case MODBUS_FC_WRITE_SINGLE_COIL:
      value = request.values[0] != 0 ? 0xff00 : 0;
      break;
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      value = request.values[0];
      break;
    default:
      value = static_cast<std::uint16_t>(request.values.size());
      break;
  }
  return word_at(pdu, 1) == request.address && word_at(pdu, 3) == value;
}

ModbusReply exception_reply(std::span<const std::uint8_t> bytes) noexcept {
  if (word_at(bytes, 4) != 1 + exception_pdu_size) return defective(ReplyDefect::length);
  const std::size_t total = header_size + exception_pdu_size;
  if (bytes.size() < total) return {};
  if (bytes.size() > total) return defective(ReplyDefect::trailing);
  return {.state = ModbusReply::State::exception, .exception_code = bytes[header_size + 1]};
}

}  // namespace

const char* text_of(ReplyDefect defect) noexcept {
  switch (defect) {
    case ReplyDefect::none:
      return "no defect";
    case ReplyDefect::transaction:
      return "the reply answers another question (transaction id)";
    case ReplyDefect::protocol:
      return "the reply is not Modbus (protocol id)";
    case ReplyDefect::length:
      return "the reply's header states a wrong length";
    case ReplyDefect::unit:
      return "another unit id answered";
    case ReplyDefect::function:
      return "the reply has another function code";
    case ReplyDefect::byte_count:
      return "the reply's byte count contradicts the question";
    case ReplyDefect::echo:
      return "the reply confirms another address or value than was written";
    case ReplyDefect::trailing:
      return "bytes follow the reply";
  }
  return "unknown";
}

ModbusReply parse_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                        std::uint16_t transaction, std::uint8_t unit) noexcept {
  const std::size_t pdu_size = reply_pdu_size(request);
  if (pdu_size == 0) return defective(ReplyDefect::function);
  const ReplyDefect defect = header_defect(bytes, pdu_size, transaction, unit);
  if (defect != ReplyDefect::none) return defective(defect);
  if (bytes.size() <= header_size) return {};

  const std::uint8_t function = bytes[header_size];
  if (function == (request.function | exception_bit)) return exception_reply(bytes);
  if (function != request.function) return defective(ReplyDefect::function);
  if (word_at(bytes, 4) != 1 + pdu_size) return defective(ReplyDefect::length);

  const bool has_data = reads(function);
  if (has_data && bytes.size() > header_size + 1 && bytes[header_size + 1] != pdu_size - 2) {
    return defective(ReplyDefect::byte_count);
  }
  const std::size_t total = outside_length + 1 + pdu_size;
  if (bytes.size() < total) return {};
  if (bytes.size() > total) return defective(ReplyDefect::trailing);
  const auto pdu = bytes.subspan(header_size);
  if (!has_data && !echoes(pdu, request)) return defective(ReplyDefect::echo);
  return {.state = ModbusReply::State::complete, .data = has_data ? pdu.subspan(2) : pdu.first(0)};
}

}  // namespace softgrip::drivers
