#include "drivers/modbus_request.h"

#include <modbus/modbus.h>

#include "drivers/big_endian.h"

namespace softgrip::drivers {
namespace {

/// Appends to a frame; the caller has checked that everything fits.
class Writer {
 public:
  explicit Writer(Frame& frame) : frame_(frame) {}
  void byte(std::size_t value) noexcept { frame_[size_++] = static_cast<std::uint8_t>(value); }
  void word(std::size_t value) noexcept {
    byte(value >> 8 & 0xff);
    byte(value & 0xff);
  }
  void words(std::span<const std::uint16_t> values) noexcept {
    for (const std::uint16_t value : values) word(value);
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  Frame& frame_;
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

std::size_t build_request(const ModbusRequest& request, std::uint16_t transaction, std::uint8_t unit,
                          Frame& frame) noexcept {
  if (reply_pdu_size(request) == 0) return 0;
  Writer out(frame);
  out.word(transaction);
  out.word(0);  // protocol: Modbus
  out.word(0);  // length, known at the end
  out.byte(unit);
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
  put_word(frame, 4, static_cast<std::uint16_t>(out.size() - 6));
  return out.size();
}

}  // namespace softgrip::drivers
