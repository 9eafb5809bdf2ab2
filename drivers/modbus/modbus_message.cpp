#include "drivers/modbus/modbus_message.h"

#include <modbus/modbus.h>

namespace softgrip::drivers {
namespace {

/// Appends values to a buffer. The caller must have checked that the buffer is large enough.
class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}
  void byte(std::size_t value) noexcept { bytes_[size_++] = static_cast<std::uint8_t>(value); }
  void word(std::size_t value) noexcept {
    byte(value >> 8 & 0xff);
    byte(value & 0xff);
  }
  void words(std::span<const std::uint16_t> values) noexcept {
    for (const std::uint16_t value : values) word(value);
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  std::span<std::uint8_t> bytes_;
  std::size_t size_ = 0;
};

bool within(std::size_t count, std::size_t most) noexcept {
  return count >= 1 && count <= most;
}

bool reads(std::uint8_t function) noexcept {
  return function <= MODBUS_FC_READ_INPUT_REGISTERS || function == MODBUS_FC_WRITE_AND_READ_REGISTERS;
}

/// Returns true if a reply confirms a write. The reply must repeat the address of the request. The reply to a
/// write of one value must also repeat this value. The reply to a write of several values must also repeat
/// their number.
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

}  // namespace

std::size_t reply_pdu_size(const ModbusRequest& request) noexcept {
  const std::size_t written = request.values.size();
  switch (request.function) {
    case MODBUS_FC_READ_COILS:
    case MODBUS_FC_READ_DISCRETE_INPUTS:
      return within(request.count, max_read_bits) ? 2U + (request.count + 7U) / 8U : 0;
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_READ_INPUT_REGISTERS:
      return within(request.count, max_read_registers) ? 2U + 2U * request.count : 0;
    case MODBUS_FC_WRITE_SINGLE_COIL:
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return written == 1 ? 5 : 0;
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return within(written, max_write_registers) ? 5 : 0;
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return within(request.count, max_read_registers) && within(written, max_fc23_write_registers)
                 ? 2U + 2U * request.count
                 : 0;
    default:
      return 0;
  }
}

std::size_t build_pdu(const ModbusRequest& request, std::span<std::uint8_t, max_pdu> pdu) noexcept {
  if (reply_pdu_size(request) == 0) return 0;
  Writer out(pdu);
  out.byte(request.function);
  out.word(request.address);
  switch (request.function) {
    case MODBUS_FC_WRITE_SINGLE_COIL:
      out.word(request.values[0] != 0 ? 0xff00 : 0);
      break;
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      out.word(request.values[0]);
      break;
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      out.word(request.values.size());
      out.byte(2 * request.values.size());
      out.words(request.values);
      break;
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      out.word(request.count);
      out.word(request.write_address);
      out.word(request.values.size());
      out.byte(2 * request.values.size());
      out.words(request.values);
      break;
    default:
      out.word(request.count);
      break;
  }
  return out.size();
}

TransactionSize size_of(const ModbusRequest& request) noexcept {
  std::array<std::uint8_t, max_pdu> pdu{};
  return {build_pdu(request, pdu), reply_pdu_size(request)};
}

const char* text_of(ReplyDefect defect) noexcept {
  switch (defect) {
    case ReplyDefect::none:
      return "no defect";
    case ReplyDefect::transaction:
      return "the reply belongs to another request (transaction id)";
    case ReplyDefect::protocol:
      return "the reply is not Modbus (protocol id)";
    case ReplyDefect::length:
      return "the reply's header states a wrong length";
    case ReplyDefect::unit:
      return "the reply has a wrong unit id";
    case ReplyDefect::function:
      return "the reply has a different function code than the request";
    case ReplyDefect::byte_count:
      return "the reply's byte count does not match the request";
    case ReplyDefect::echo:
      return "the reply confirms an address or value that differs from the written one";
    case ReplyDefect::trailing:
      return "additional bytes were received after the reply";
    case ReplyDefect::checksum:
      return "the reply was damaged in transmission (checksum)";
    case ReplyDefect::own_echo:
      return "the line returns the sent bytes (for such an adapter, set `echo: true` in the rig file)";
  }
  return "unknown";
}

std::size_t pdu_size_of(const ModbusReply& reply, const ModbusRequest& request) noexcept {
  return reply.state == ModbusReply::State::exception ? exception_pdu_size : reply_pdu_size(request);
}

ModbusReply parse_pdu(std::span<const std::uint8_t> pdu, const ModbusRequest& request) noexcept {
  const std::size_t size = reply_pdu_size(request);
  if (size == 0) return defective(ReplyDefect::function);
  if (pdu.empty()) return {};
  const std::uint8_t function = pdu[0];
  if (function == (request.function | exception_bit)) {
    if (pdu.size() < exception_pdu_size) return {};
    return {.state = ModbusReply::State::exception, .exception_code = pdu[1]};
  }
  if (function != request.function) return defective(ReplyDefect::function);
  const bool has_data = reads(function);
  if (has_data && pdu.size() > 1 && pdu[1] != size - 2) return defective(ReplyDefect::byte_count);
  if (pdu.size() < size) return {};
  if (!has_data && !echoes(pdu, request)) return defective(ReplyDefect::echo);
  return {.state = ModbusReply::State::complete, .data = has_data ? pdu.subspan(2, size - 2) : pdu.first(0)};
}

const char* text_of_exception(unsigned code) noexcept {
  // The texts of libmodbus are used only for known codes. For an unknown code, libmodbus would call
  // strerror(), which allocates memory.
  const bool known = code >= MODBUS_EXCEPTION_ILLEGAL_FUNCTION && code < MODBUS_EXCEPTION_MAX &&
                     code != MODBUS_EXCEPTION_NOT_DEFINED;
  return known ? ::modbus_strerror(MODBUS_ENOBASE + static_cast<int>(code))
               : "not an exception code of the Modbus standard";
}

}  // namespace softgrip::drivers
