#include "drivers/modbus/rtu_frame.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace softgrip::drivers::rtu_frame_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using State = ModbusReply::State;

Bytes built(const ModbusRequest& request, std::uint8_t unit) {
  Frame frame{};
  const std::size_t size = build_rtu_request(request, unit, frame);
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

Bytes with_crc(Bytes bytes) {
  const std::uint16_t crc = crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

ModbusReply parse(const Bytes& bytes, const ModbusRequest& request, std::uint8_t unit = 1) {
  return parse_rtu_reply(bytes, request, unit, built(request, unit));
}

/// Compares computed checksums with published ones: those in the Modbus specification (serial line, V1.02,
/// section 6.2.2) and those in the manuals of vendors.
TEST(RtuFrame, ChecksumsMatchPublishedExamples) {
  EXPECT_EQ(crc16(Bytes{0x02, 0x07}), 0x1241);
  const std::vector<std::uint16_t> one_milliampere{1000};
  EXPECT_EQ(built({.function = 6, .address = 0, .values = one_milliampere}, 1),
            (Bytes{0x01, 0x06, 0x00, 0x00, 0x03, 0xe8, 0x89, 0x74}));
  EXPECT_EQ(built({.function = 4, .address = 0, .count = 8}, 1),
            (Bytes{0x01, 0x04, 0x00, 0x00, 0x00, 0x08, 0xf1, 0xcc}));
}

TEST(RtuFrame, OnlyACompleteCorrectResponseIsComplete) {
  const std::vector<std::uint16_t> two{7, 8};
  struct Case {
    ModbusRequest request;
    Bytes reply;
    std::size_t data;
  };
  const std::vector<Case> cases{
      {{.function = 3, .address = 5, .count = 2}, {1, 3, 4, 1, 2, 3, 4}, 4},
      {{.function = 1, .address = 5, .count = 9}, {1, 1, 2, 0xff, 1}, 2},
      {{.function = 16, .address = 5, .values = two}, {1, 16, 0, 5, 0, 2}, 0},
      {{.function = 6, .address = 5, .values = std::span(two).first(1)}, {1, 6, 0, 5, 0, 7}, 0}};
  for (const Case& one : cases) {
    const Bytes whole = with_crc(one.reply);
    EXPECT_EQ(parse(whole, one.request).state, State::complete) << int{one.request.function};
    EXPECT_EQ(parse(whole, one.request).data.size(), one.data);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_EQ(
          parse(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), one.request).state,
          State::incomplete);
    }
    Bytes longer = whole;
    longer.push_back(0);
    EXPECT_EQ(parse(longer, one.request).defect, ReplyDefect::trailing);
  }
}

TEST(RtuFrame, ParsesAnExceptionOfFiveBytes) {
  const ModbusRequest request{.function = 4, .address = 0, .count = 8};
  const Bytes whole = with_crc({1, 0x84, 2});
  const ModbusReply reply = parse(whole, request);
  EXPECT_EQ(reply.state, State::exception);
  EXPECT_EQ(reply.exception_code, 2);
}

TEST(RtuFrame, AnySingleBitThatFlipsIsFound) {
  const ModbusRequest request{.function = 3, .address = 5, .count = 4};
  const Bytes whole = with_crc({1, 3, 8, 1, 2, 3, 4, 5, 6, 7, 8});
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_NE(parse(damaged, request).state, State::complete) << bit;
  }
}

TEST(RtuFrame, DetectsAnotherUnitAndTheEchoOfTheRequest) {
  const ModbusRequest read{.function = 3, .address = 0x105, .count = 4};
  EXPECT_EQ(parse(with_crc({2, 3, 8, 1, 2, 3, 4, 5, 6, 7, 8}), read).defect, ReplyDefect::unit);
  EXPECT_EQ(parse(built(read, 1), read).defect, ReplyDefect::own_echo);
  const std::vector<std::uint16_t> two{7, 8};
  const ModbusRequest write{.function = 16, .address = 5, .values = two};
  EXPECT_EQ(parse(built(write, 1), write).defect, ReplyDefect::own_echo);
}

TEST(RtuFrame, AcceptsNoiseOnlyAtTheRateOfTheChecksum) {
  constexpr unsigned seed = 20261120;
  std::mt19937 random(seed);
  const ModbusRequest request{.function = 3, .address = 5, .count = 2};
  int complete = 0;
  for (int i = 0; i < 200'000; ++i) {
    Bytes noise{1, 3, 4, 0, 0, 0, 0, 0, 0};
    for (std::size_t at = 3; at < noise.size(); ++at) noise[at] = static_cast<std::uint8_t>(random());
    complete += parse(noise, request).state == State::complete ? 1 : 0;
  }
  // A 16-bit checksum accepts one random frame in 65536, so the expected number of accepted frames is 3. The
  // probability of more than 12 accepted frames is below 1e-4.
  EXPECT_LE(complete, 12) << "seed " << seed;
}

}  // namespace
}  // namespace softgrip::drivers::rtu_frame_test
