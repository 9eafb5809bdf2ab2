#include "drivers/modbus/modbus_message.h"

namespace softgrip::drivers {
namespace {

/// Returns the first defect in the received part of the header; `none` if this part has no defect.
ReplyDefect header_defect(std::span<const std::uint8_t> bytes, std::size_t pdu_size,
                          std::uint16_t transaction, std::uint8_t unit) noexcept {
  if (bytes.size() >= 2 && word_at(bytes, 0) != transaction) return ReplyDefect::transaction;
  if (bytes.size() >= 4 && word_at(bytes, 2) != 0) return ReplyDefect::protocol;
  if (bytes.size() >= 6) {
    const std::size_t length = word_at(bytes, 4);
    if (length != 1 + pdu_size && length != 1 + exception_pdu_size) return ReplyDefect::length;
  }
  if (bytes.size() >= mbap_size && bytes[6] != unit) return ReplyDefect::unit;
  return ReplyDefect::none;
}

}  // namespace

std::size_t put_mbap(std::span<std::uint8_t> frame, std::size_t pdu_size, std::uint16_t transaction,
                     std::uint8_t unit) noexcept {
  put_word(frame, 0, transaction);
  put_word(frame, 2, 0);  // the protocol id 0 means Modbus
  put_word(frame, 4, static_cast<std::uint16_t>(1 + pdu_size));
  frame[6] = unit;
  return mbap_size + pdu_size;
}

std::size_t build_request(const ModbusRequest& request, std::uint16_t transaction, std::uint8_t unit,
                          Frame& frame) noexcept {
  const std::size_t size = build_pdu(request, std::span(frame).subspan<mbap_size>());
  return size == 0 ? 0 : put_mbap(frame, size, transaction, unit);
}

ModbusReply parse_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                        std::uint16_t transaction, std::uint8_t unit) noexcept {
  const std::size_t pdu_size = reply_pdu_size(request);
  if (pdu_size == 0) return defective(ReplyDefect::function);
  const ReplyDefect defect = header_defect(bytes, pdu_size, transaction, unit);
  if (defect != ReplyDefect::none) return defective(defect);
  if (bytes.size() <= mbap_size) return {};

  // The length in the header must be the length of the expected response or of an exception response.
  const std::uint8_t function = bytes[mbap_size];
  const bool exception = function == (request.function | exception_bit);
  if (!exception && function != request.function) return defective(ReplyDefect::function);
  const std::size_t size = exception ? exception_pdu_size : pdu_size;
  if (word_at(bytes, 4) != 1 + size) return defective(ReplyDefect::length);
  if (bytes.size() > mbap_size + size) return defective(ReplyDefect::trailing);
  return parse_pdu(bytes.subspan(mbap_size), request);
}

}  // namespace softgrip::drivers
