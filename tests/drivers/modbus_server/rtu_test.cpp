#include "drivers/modbus_server/requests.h"

#include <gtest/gtest.h>

#include <random>

namespace softgrip::modbus::rtu_test {
namespace {

using namespace std::chrono_literals;

const Clock::time_point start{};

Bytes read_request(std::uint8_t unit = 1) {
  return frame_on(Wire::rtu, 0, unit, Bytes{4, 0, 0, 0, 8});
}

TEST(RtuRequestStream, SeparatesRequestsByLength) {
  const std::vector<Bytes> pdus{{4, 0, 0, 0, 8},
                                {5, 0, 1, 0xff, 0},
                                {6, 0, 1, 0, 7},
                                {16, 0, 0, 0, 2, 4, 1, 2, 3, 4},
                                {23, 0, 0, 0, 2, 0, 9, 0, 1, 2, 7, 7}};
  RtuRequestStream stream;
  Bytes all;
  for (const Bytes& pdu : pdus) {
    const Bytes frame = frame_on(Wire::rtu, 0, 3, pdu);
    all.insert(all.end(), frame.begin(), frame.end());
  }
  std::vector<Bytes> found;
  for (const std::uint8_t byte : all) {
    stream.append(Bytes{byte}, start);
    while (const auto request = stream.next()) {
      EXPECT_EQ(request->unit, 3);
      found.push_back(request->pdu);
    }
  }
  EXPECT_EQ(found, pdus);
}

TEST(RtuRequestStream, ReturnsARequestWithAnUnknownFunction) {
  RtuRequestStream stream;
  stream.append(frame_on(Wire::rtu, 0, 1, Bytes{43, 14, 1, 0}), start);
  const auto request = stream.next();
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->pdu[0], 43);
}

TEST(RtuRequestStream, IgnoresARequestWithAWrongChecksum) {
  RtuRequestStream stream;
  Bytes damaged = read_request();
  damaged[3] = 1;
  stream.append(damaged, start);
  EXPECT_FALSE(stream.next().has_value());
  stream.append(read_request(), start + 1s);
  EXPECT_TRUE(stream.next().has_value()) << "the next request is received";
}

TEST(RtuRequestStream, DiscardsAnIncompleteRequestAfterASilence) {
  RtuRequestStream stream;
  Bytes begun = read_request();
  begun.resize(5);
  stream.append(begun, start);
  EXPECT_FALSE(stream.next().has_value());
  stream.append(read_request(), start + 1s);
  EXPECT_TRUE(stream.next().has_value());
}

TEST(RtuRequestStream, ReceivesARequestAfterNoise) {
  constexpr unsigned seed = 7;
  std::mt19937 random(seed);
  RtuRequestStream stream;
  for (int i = 0; i < 20'000; ++i) {
    Bytes noise(random() % 40);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    stream.append(noise, start);
    while (stream.next()) {
    }
  }
  stream.append(read_request(), start + 1s);
  EXPECT_TRUE(stream.next().has_value()) << "seed " << seed;
}

}  // namespace
}  // namespace softgrip::modbus::rtu_test
