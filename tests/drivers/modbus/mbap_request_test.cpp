// Compares the frames of requests with the examples in section 6 of the specification "Modbus application
// protocol V1.1b3".

#include "drivers/modbus/modbus_message.h"

#include <gtest/gtest.h>

#include <vector>

namespace softgrip::drivers::mbap_request_test {
namespace {

std::vector<std::uint8_t> pdu_of(const ModbusRequest& request) {
  Frame frame{};
  const std::size_t size = build_request(request, 0x1234, 0x11, frame);
  if (size < 8) return {};
  const std::vector<std::uint8_t> header(frame.begin(), frame.begin() + 7);
  const std::vector<std::uint8_t> expected{0x12, 0x34, 0, 0, 0, static_cast<std::uint8_t>(size - 6), 0x11};
  EXPECT_EQ(header, expected);
  return {frame.begin() + 7, frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

using Bytes = std::vector<std::uint8_t>;

TEST(ModbusRequest, MatchesTheExamplesOfTheSpecification) {
  EXPECT_EQ(pdu_of({.function = 1, .address = 0x13, .count = 0x13}), (Bytes{1, 0, 0x13, 0, 0x13}));
  EXPECT_EQ(pdu_of({.function = 2, .address = 0xc4, .count = 0x16}), (Bytes{2, 0, 0xc4, 0, 0x16}));
  EXPECT_EQ(pdu_of({.function = 3, .address = 0x6b, .count = 3}), (Bytes{3, 0, 0x6b, 0, 3}));
  EXPECT_EQ(pdu_of({.function = 4, .address = 8, .count = 1}), (Bytes{4, 0, 8, 0, 1}));
  const std::vector<std::uint16_t> on{1};
  EXPECT_EQ(pdu_of({.function = 5, .address = 0xac, .values = on}), (Bytes{5, 0, 0xac, 0xff, 0}));
  const std::vector<std::uint16_t> three{3};
  EXPECT_EQ(pdu_of({.function = 6, .address = 1, .values = three}), (Bytes{6, 0, 1, 0, 3}));
  const std::vector<std::uint16_t> two{0x000a, 0x0102};
  EXPECT_EQ(pdu_of({.function = 16, .address = 1, .values = two}),
            (Bytes{0x10, 0, 1, 0, 2, 4, 0, 0x0a, 1, 2}));
  const std::vector<std::uint16_t> ff{0xff, 0xff, 0xff};
  EXPECT_EQ(pdu_of({.function = 23, .address = 3, .count = 6, .write_address = 0x0e, .values = ff}),
            (Bytes{0x17, 0, 3, 0, 6, 0, 0x0e, 0, 3, 6, 0, 0xff, 0, 0xff, 0, 0xff}));
}

TEST(ModbusRequest, RefusesInvalidRequests) {
  Frame frame{};
  const std::vector<std::uint16_t> many(124);
  const auto values = std::span<const std::uint16_t>(many);
  const std::vector<ModbusRequest> refused{
      {},
      {.function = 3, .count = 0},
      {.function = 3, .count = 126},
      {.function = 1, .count = 2001},
      {.function = 6},
      {.function = 6, .values = values.first(2)},
      {.function = 16},
      {.function = 16, .values = values},
      {.function = 23, .count = 1},
      {.function = 23, .count = 126, .values = values.first(1)},
      {.function = 23, .count = 1, .values = values.first(122)},
      {.function = 15, .count = 1, .values = values.first(1)},
      {.function = 43, .count = 1},
  };
  for (const ModbusRequest& request : refused) {
    EXPECT_EQ(reply_pdu_size(request), 0U) << int{request.function} << ' ' << request.count;
    EXPECT_EQ(build_request(request, 1, 1, frame), 0U);
  }
}

TEST(ModbusRequest, TheLargestRequestsFitIntoAFrame) {
  Frame frame{};
  const std::vector<std::uint16_t> values(123, 0xabcd);
  const auto all = std::span<const std::uint16_t>(values);
  EXPECT_EQ(build_request({.function = 16, .values = all}, 1, 1, frame), 7U + 6U + 246U);
  EXPECT_EQ(build_request({.function = 23, .count = 125, .values = all.first(121)}, 1, 1, frame),
            7U + 10U + 242U);
}

}  // namespace
}  // namespace softgrip::drivers::mbap_request_test
