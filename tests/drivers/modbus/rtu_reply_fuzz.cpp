// Fuzz target: receives arbitrary bytes as a response on a serial line and parses the response after each
// byte. The parser must not accept a response without a correct checksum and must not read beyond the last
// byte.

#include <array>
#include <cstdint>
#include <span>

#include "drivers/modbus/rtu_frame.h"
#include "tests/support/require.h"

namespace {

using test::require;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgrip::drivers;
  using State = ModbusReply::State;
  constexpr std::array<std::uint8_t, 9> functions{1, 2, 3, 4, 5, 6, 16, 23, 99};
  constexpr std::size_t choices = 4;
  if (size < choices) return 0;
  const std::array<std::uint16_t, 2> values{7, 8};
  ModbusRequest request;
  request.function = functions.at(data[0] % functions.size());
  request.address = data[1];
  request.count = data[2] % 128;
  request.values = std::span(values).first(data[3] % 3);
  const std::span<const std::uint8_t> bytes(data + choices, size - choices);
  Frame frame{};
  const std::size_t asked = build_rtu_request(request, 1, frame);
  State last = State::incomplete;
  for (std::size_t have = 0; have <= bytes.size(); ++have) {
    const ModbusReply reply =
        parse_rtu_reply(bytes.first(have), request, 1, std::span<const std::uint8_t>(frame).first(asked));
    if (last != State::incomplete) require(reply.state == State::defective);
    require((reply.defect == ReplyDefect::none) == (reply.state != State::defective));
    if (reply.state == State::complete || reply.state == State::exception) {
      require(have == pdu_size_of(reply, request) + rtu_overhead);
      const std::uint16_t crc = crc16(bytes.first(have - 2));
      require(bytes[have - 2] == (crc & 0xff) && bytes[have - 1] == crc >> 8);
    }
    last = reply.state;
  }
  return 0;
}
