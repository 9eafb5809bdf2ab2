#include "drivers/modbus/rtu_frame.h"

#include <algorithm>

namespace softgrip::drivers {
namespace {

constexpr std::size_t crc_size = 2;

bool begins_with(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> begin) noexcept {
  return bytes.size() >= begin.size() && std::equal(begin.begin(), begin.end(), bytes.begin());
}

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept {
  unsigned crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xa001U : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

std::size_t put_rtu_ends(std::span<std::uint8_t> frame, std::size_t pdu_size, std::uint8_t unit) noexcept {
  frame[0] = unit;
  const std::uint16_t crc = crc16(frame.first(1 + pdu_size));
  frame[1 + pdu_size] = static_cast<std::uint8_t>(crc & 0xff);
  frame[2 + pdu_size] = static_cast<std::uint8_t>(crc >> 8);
  return pdu_size + rtu_overhead;
}

bool crc_holds(std::span<const std::uint8_t> frame) noexcept {
  const std::size_t end = frame.size() - crc_size;
  const std::uint16_t crc = crc16(frame.first(end));
  return frame[end] == (crc & 0xff) && frame[end + 1] == crc >> 8;
}

std::size_t build_rtu_request(const ModbusRequest& request, std::uint8_t unit, Frame& frame) noexcept {
  const std::size_t size = build_pdu(request, std::span(frame).subspan<1, max_pdu>());
  return size == 0 ? 0 : put_rtu_ends(frame, size, unit);
}

ModbusReply parse_rtu_reply(std::span<const std::uint8_t> bytes, const ModbusRequest& request,
                            std::uint8_t unit, std::span<const std::uint8_t> asked) noexcept {
  if (bytes.empty()) return {};
  if (bytes[0] != unit) return defective(ReplyDefect::unit);
  const ModbusReply reply = parse_pdu(bytes.subspan(1), request);
  if (reply.state == ModbusReply::State::incomplete) return reply;
  // If the received bytes are equal to the request, the serial line returns the sent bytes (echo). For the
  // function codes 5 and 6, an echo is equal to a correct response and cannot be detected.
  if (reply.state == ModbusReply::State::defective) {
    return bytes.size() > 4 && begins_with(bytes, asked.first(std::min(asked.size(), bytes.size())))
               ? defective(ReplyDefect::own_echo)
               : reply;
  }
  const std::size_t size = 1 + pdu_size_of(reply, request);
  if (bytes.size() < size + crc_size) return {};
  if (!crc_holds(bytes.first(size + crc_size))) {
    return defective(begins_with(bytes, asked) ? ReplyDefect::own_echo : ReplyDefect::checksum);
  }
  if (bytes.size() > size + crc_size) return defective(ReplyDefect::trailing);
  return reply;
}

}  // namespace softgrip::drivers
