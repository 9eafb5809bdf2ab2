#include "drivers/modbus_server/requests.h"

#include <gtest/gtest.h>

namespace softgrip::modbus::mbap_test {
namespace {

const Bytes read_four{0x00, 0x07, 0x00, 0x00, 0x00, 0x06, 0x01, 0x03, 0x00, 0x00, 0x00, 0x04};

TEST(RequestStream, AssemblesARequestFromChunksOfAnySize) {
  for (std::size_t chunk = 1; chunk <= read_four.size(); ++chunk) {
    RequestStream stream;
    std::optional<Request> request;
    for (std::size_t i = 0; i < read_four.size(); i += chunk) {
      EXPECT_FALSE(request)
          << "the server regards the request as complete too early if the request arrives in chunks of "
          << chunk << " bytes";
      stream.append(std::span(read_four).subspan(i, std::min(chunk, read_four.size() - i)));
      request = stream.next();
    }
    ASSERT_TRUE(request) << "the request arrives in chunks of " << chunk << " bytes";
    EXPECT_EQ(request->transaction, 7);
    EXPECT_EQ(request->unit, 1);
    EXPECT_EQ(request->pdu, (Bytes{0x03, 0x00, 0x00, 0x00, 0x04}));
    EXPECT_FALSE(stream.next());
    EXPECT_FALSE(stream.broken());
  }
}

TEST(RequestStream, SeparatesTwoRequestsInOneChunk) {
  Bytes both = read_four;
  both.insert(both.end(), read_four.begin(), read_four.end());
  both[read_four.size() + 1] = 8;
  RequestStream stream;
  stream.append(both);
  ASSERT_EQ(stream.next()->transaction, 7);
  ASSERT_EQ(stream.next()->transaction, 8);
  EXPECT_FALSE(stream.next());
}

TEST(RequestStream, RefusesAnInvalidHeader) {
  const auto broken_by = [](std::size_t position, std::uint8_t value) {
    Bytes bytes = read_four;
    bytes[position] = value;
    RequestStream stream;
    stream.append(bytes);
    const bool nothing = !stream.next();
    return nothing && stream.broken();
  };
  EXPECT_TRUE(broken_by(2, 1)) << "wrong protocol id";
  EXPECT_TRUE(broken_by(4, 1)) << "length above the longest frame";
  EXPECT_TRUE(broken_by(5, 0)) << "length 0";
  EXPECT_TRUE(broken_by(5, 1)) << "no function code";
}

TEST(RequestStream, AcceptsTheLongestFrameAndNotMore) {
  for (const std::size_t size : {max_pdu, max_pdu + 1}) {
    const Bytes whole = frame_on(Wire::tcp, 1, 1, Bytes(size, 0x10));
    RequestStream stream;
    stream.append(whole);
    EXPECT_EQ(stream.next().has_value(), size == max_pdu);
    EXPECT_EQ(stream.broken(), size != max_pdu);
  }
}

TEST(RequestStream, LimitsTheStoredBytes) {
  RequestStream stream;
  const Bytes silence(10'000, 0);
  for (int i = 0; i < 3 && !stream.broken(); ++i) stream.append(silence);
  EXPECT_TRUE(stream.broken());
}

TEST(Frame, AWrittenFrameIsParsedCorrectly) {
  RequestStream stream;
  stream.append(frame_on(Wire::tcp, 0xabcd, 17, Bytes{0x04, 0x00, 0x01, 0x00, 0x02}));
  const auto request = stream.next();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->transaction, 0xabcd);
  EXPECT_EQ(request->unit, 17);
  EXPECT_EQ(request->pdu, (Bytes{0x04, 0x00, 0x01, 0x00, 0x02}));
}

}  // namespace
}  // namespace softgrip::modbus::mbap_test
