#include "drivers/modbus/modbus_request.h"

#include <modbus/modbus.h>

#include <array>

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

}  // namespace softgrip::drivers
