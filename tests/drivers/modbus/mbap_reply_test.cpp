#include "drivers/modbus/modbus_message.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace softgrip::drivers::mbap_reply_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using State = ModbusReply::State;

constexpr std::uint16_t transaction = 0x0102;
constexpr std::uint8_t unit = 17;

/// A request and its correct response. The last bytes of the response are the data.
struct Case {
  ModbusRequest request;
  Bytes pdu;
  std::size_t data_size;
};

const std::vector<std::uint16_t>& written() {
  static const std::vector<std::uint16_t> values{0x0304, 0x0506};
  return values;
}

std::vector<Case> cases() {
  const auto values = std::span<const std::uint16_t>(written());
  return {
      {{.function = 1, .address = 5, .count = 9}, {1, 2, 0xff, 1}, 2},
      {{.function = 2, .address = 5, .count = 8}, {2, 1, 0xa5}, 1},
      {{.function = 3, .address = 5, .count = 2}, {3, 4, 1, 2, 3, 4}, 4},
      {{.function = 4, .address = 5, .count = 1}, {4, 2, 9, 8}, 2},
      {{.function = 5, .address = 7, .values = values.first(1)}, {5, 0, 7, 0xff, 0}, 0},
      {{.function = 6, .address = 7, .values = values.first(1)}, {6, 0, 7, 3, 4}, 0},
      {{.function = 16, .address = 0x107, .values = values}, {16, 1, 7, 0, 2}, 0},
      {{.function = 23, .address = 5, .count = 2, .write_address = 9, .values = values},
       {23, 4, 1, 2, 3, 4},
       4},
  };
}

Bytes frame(const Bytes& pdu) {
  Bytes bytes;
  for (const int byte : {1, 2, 0, 0, 0, static_cast<int>(pdu.size() + 1), int{unit}}) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  for (const std::uint8_t byte : pdu) bytes.push_back(byte);
  return bytes;
}

ModbusReply parse(const Bytes& bytes, const ModbusRequest& request) {
  return parse_reply(bytes, request, transaction, unit);
}

TEST(ModbusReply, CorrectResponsesAreComplete) {
  for (const Case& one : cases()) {
    const Bytes bytes = frame(one.pdu);
    const ModbusReply reply = parse(bytes, one.request);
    ASSERT_EQ(reply.state, State::complete) << int{one.request.function} << text_of(reply.defect);
    EXPECT_EQ(reply.data.size(), one.data_size);
    EXPECT_EQ(Bytes(reply.data.begin(), reply.data.end()),
              Bytes(one.pdu.end() - static_cast<std::ptrdiff_t>(one.data_size), one.pdu.end()));
  }
}

TEST(ModbusReply, ATruncatedResponseIsIncomplete) {
  for (const Case& one : cases()) {
    const Bytes bytes = frame(one.pdu);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_EQ(parse(part, one.request).state, State::incomplete)
          << int{one.request.function} << ' ' << size;
    }
    const Bytes exception = frame({static_cast<std::uint8_t>(one.request.function | 0x80), 4});
    for (std::size_t size = 0; size < exception.size(); ++size) {
      const Bytes part(exception.begin(), exception.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_EQ(parse(part, one.request).state, State::incomplete);
    }
    EXPECT_EQ(parse(exception, one.request).state, State::exception);
    EXPECT_EQ(parse(exception, one.request).exception_code, 4);
  }
}

TEST(ModbusReply, ATrailingByteIsADefect) {
  for (const Case& one : cases()) {
    Bytes bytes = frame(one.pdu);
    bytes.push_back(0);
    EXPECT_EQ(parse(bytes, one.request).defect, ReplyDefect::trailing);
    Bytes exception = frame({static_cast<std::uint8_t>(one.request.function | 0x80), 4});
    exception.push_back(0);
    EXPECT_EQ(parse(exception, one.request).defect, ReplyDefect::trailing);
  }
}

// Changes one bit in the header, the function code, the byte count or the echo of a response. The parser must
// never accept the response. A response with a changed highest bit of the function code looks like an
// exception of the wrong length. The test does not change the data, because only the checksum of TCP protects
// them.
TEST(ModbusReply, AnInvertedBitOutsideTheDataIsADefect) {
  for (const Case& one : cases()) {
    const Bytes right = frame(one.pdu);
    for (std::size_t i = 0; i < right.size() - one.data_size; ++i) {
      for (int bit = 0; bit < 8; ++bit) {
        Bytes bytes = right;
        bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ 1 << bit);
        EXPECT_EQ(parse(bytes, one.request).state, State::defective)
            << "function " << int{one.request.function} << " byte " << i << " bit " << bit;
      }
    }
  }
}

TEST(ModbusReply, DistinguishesTheDefects) {
  const Case one = cases()[2];
  const auto spoiled = [&](std::size_t at, std::uint8_t value) {
    Bytes bytes = frame(one.pdu);
    bytes.at(at) = value;
    return parse(bytes, one.request).defect;
  };
  EXPECT_EQ(spoiled(1, 9), ReplyDefect::transaction);
  EXPECT_EQ(spoiled(3, 1), ReplyDefect::protocol);
  EXPECT_EQ(spoiled(5, 8), ReplyDefect::length);
  EXPECT_EQ(spoiled(5, 3), ReplyDefect::length);
  EXPECT_EQ(spoiled(6, 1), ReplyDefect::unit);
  EXPECT_EQ(spoiled(7, 4), ReplyDefect::function);
  EXPECT_EQ(spoiled(8, 2), ReplyDefect::byte_count);
  const Case write = cases()[5];
  Bytes other = frame(write.pdu);
  other.back() = 5;
  EXPECT_EQ(parse(other, write.request).defect, ReplyDefect::echo);
}

TEST(ModbusReply, DetectsAWrongHeaderInATruncatedResponse) {
  const Case one = cases()[2];
  EXPECT_EQ(parse({1, 3}, one.request).defect, ReplyDefect::transaction);
  EXPECT_EQ(parse({1, 2, 0, 7}, one.request).defect, ReplyDefect::protocol);
  EXPECT_EQ(parse({1, 2, 0, 0, 1, 0}, one.request).defect, ReplyDefect::length);
  EXPECT_EQ(parse({1, 2, 0, 0, 0, 7, 3}, one.request).defect, ReplyDefect::unit);
}

TEST(ModbusReply, AnInvalidRequestHasNoValidResponse) {
  EXPECT_EQ(parse(frame({3, 2, 0, 0}), {.function = 3, .count = 0}).state, State::defective);
}

TEST(ModbusReply, DataLieWithinTheReceivedBytes) {
  const unsigned seed = 3;
  std::mt19937 random(seed);
  const std::vector<Case> all = cases();
  for (int i = 0; i < 200'000; ++i) {
    const Case& one = all[random() % all.size()];
    Bytes bytes = frame(one.pdu);
    bytes.resize(random() % 300, static_cast<std::uint8_t>(random()));
    for (int flips = static_cast<int>(random() % 4); flips > 0 && !bytes.empty(); --flips) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    const ModbusReply reply = parse(bytes, one.request);
    if (reply.data.empty()) continue;
    ASSERT_EQ(reply.state, State::complete);
    ASSERT_GE(reply.data.data(), bytes.data());
    ASSERT_LE(reply.data.data() + reply.data.size(), bytes.data() + bytes.size());
  }
}

}  // namespace
}  // namespace softgrip::drivers::mbap_reply_test
