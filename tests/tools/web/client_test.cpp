#include "tools/web/client.h"

#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "base/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace softgrip::web::client_test {
namespace {

using Phase = Client::Phase;

class ClientTest : public ::testing::Test {
 protected:
  static std::pair<Descriptor, Descriptor> connected() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
  }
  explicit ClientTest(std::pair<Descriptor, Descriptor> ends = connected())
      : client_(std::move(ends.first), 0), other_(std::move(ends.second)) {}
  void send_text(const std::string& text) {
    ASSERT_EQ(::send(other_.get(), text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  }
  std::string received() {
    std::string text(1U << 21U, '\0');
    const ssize_t count = ::recv(other_.get(), text.data(), text.size(), 0);
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return text;
  }

  Client client_;
  Descriptor other_;
};

TEST_F(ClientTest, AssemblesARequestFromPiecesAndSendsTheResponse) {
  send_text("GET / ");
  EXPECT_TRUE(client_.receive());
  send_text("HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(client_.receive());
  EXPECT_EQ(client_.request(), "GET / HTTP/1.1\r\n\r\n");
  client_.respond("good", Phase::responding, 1);
  EXPECT_FALSE(client_.send_pending(1)) << "all bytes have been sent";
  EXPECT_EQ(received(), "good");
}

TEST_F(ClientTest, DetectsAClosedConnection) {
  client_.respond("hello", Phase::streaming, 0);
  other_.reset();
  EXPECT_FALSE(client_.receive());
}

TEST_F(ClientTest, AHalfClosedConnectionStillReceivesTheResponse) {
  send_text("GET / HTTP/1.1\r\n\r\n");
  ASSERT_EQ(::shutdown(other_.get(), SHUT_WR), 0);
  EXPECT_TRUE(client_.receive());
  client_.wait();
  EXPECT_TRUE(client_.receive());
  EXPECT_TRUE(client_.input_closed());
  client_.respond("good", Phase::responding, 1);
  EXPECT_FALSE(client_.send_pending(1));
  EXPECT_EQ(received(), "good");
  EXPECT_FALSE(client_.receive()) << "if a read ends without data a second time, the connection is broken";
}

TEST_F(ClientTest, ReceivesALimitedNumberOfBytesPerCycle) {
  const int large = 1 << 22;
  ::setsockopt(other_.get(), SOL_SOCKET, SO_SNDBUF, &large, sizeof large);
  std::size_t sent = 0;
  const std::string flood(4096, 'x');
  for (ssize_t count = 0; (count = ::send(other_.get(), flood.data(), flood.size(), 0)) > 0;)
    sent += static_cast<std::size_t>(count);
  ASSERT_GT(sent, 100'000U);
  EXPECT_TRUE(client_.receive());
  int left = 0;
  ASSERT_EQ(::ioctl(client_.descriptor(), FIONREAD, &left), 0);
  EXPECT_GT(left, 0) << "the remaining bytes must be sent in the next turn of the server";
}

TEST_F(ClientTest, AFileIsSentInPieces) {
  client_.respond("head", Phase::sending_file, 0);
  EXPECT_TRUE(client_.send_pending(0)) << "more pieces follow";
  EXPECT_FALSE(client_.has_unsent());
  EXPECT_TRUE(client_.add("-one"));
  EXPECT_TRUE(client_.send_pending(0));
  EXPECT_TRUE(client_.timed_out(Client::stall_timeout + 1))
      << "the time limit includes the wait for a disk that does not respond";
  EXPECT_TRUE(client_.add("-two"));
  client_.finish();
  EXPECT_FALSE(client_.send_pending(0));
  EXPECT_EQ(received(), "head-one-two");
}

TEST_F(ClientTest, SendsALimitedNumberOfBytesPerCycle) {
  const int large = 1 << 22;
  ::setsockopt(client_.descriptor(), SOL_SOCKET, SO_SNDBUF, &large, sizeof large);
  client_.respond(std::string(2 * Client::max_per_send, 'x'), Phase::responding, 0);
  EXPECT_TRUE(client_.send_pending(0));
  EXPECT_GE(client_.unsent(), Client::max_per_send);
}

TEST_F(ClientTest, LimitsTheStoredBytesOfARequest) {
  for (int i = 0; i < 100; ++i) {
    send_text(std::string(4000, 'x'));
    EXPECT_TRUE(client_.receive());
  }
  EXPECT_LT(client_.request().size(), 40000U);
}

TEST_F(ClientTest, ASlowClientExceedsTheTimeLimit) {
  EXPECT_FALSE(client_.timed_out(Client::request_timeout));
  EXPECT_TRUE(client_.timed_out(Client::request_timeout + 1));
  client_.wait();
  EXPECT_EQ(client_.phase(), Phase::waiting);
  EXPECT_FALSE(client_.timed_out(100 * ns_per_s))
      << "the time in which the client waits for the daemon must not count";
  client_.respond(std::string(1U << 22U, 'x'), Phase::responding, 0);
  EXPECT_TRUE(client_.send_pending(0));
  EXPECT_TRUE(client_.has_unsent());
  EXPECT_TRUE(client_.timed_out(Client::stall_timeout + 1));
}

TEST_F(ClientTest, AClientThatReadsSlowlyExceedsTheTotalTimeLimit) {
  client_.respond(std::string(1U << 24U, 'x'), Phase::responding, 0);
  Nanoseconds now = 0;
  for (; !client_.timed_out(now) && now < 200 * ns_per_s; now += ns_per_s) {
    ASSERT_TRUE(client_.send_pending(now));
    std::string little(100'000, '\0');
    EXPECT_GT(::recv(other_.get(), little.data(), little.size(), 0), 0);
  }
  EXPECT_GT(now, Client::stall_timeout)
      << "the client reads some data, so the limit for a pause must not apply";
  EXPECT_LE(now, Client::response_timeout + 2 * ns_per_s);
}

TEST_F(ClientTest, LimitsTheUnreadBytesOfAStream) {
  client_.respond("hello", Phase::streaming, 0);
  EXPECT_EQ(client_.phase(), Phase::streaming);
  EXPECT_TRUE(client_.send_pending(0));
  const std::string message(10000, 'm');
  int buffered = 0;
  for (; buffered < 1000 && client_.add(message); ++buffered) EXPECT_TRUE(client_.send_pending(0));
  EXPECT_LT(buffered, 200) << "the client must not keep more than the buffer of the socket and 1 MB";
  EXPECT_TRUE(client_.timed_out(Client::stall_timeout + 1));
}

TEST_F(ClientTest, AStreamEndsAfterAllPendingBytesAreSent) {
  client_.respond("hello", Phase::streaming, 0);
  client_.finish();
  EXPECT_TRUE(client_.add("!"));
  EXPECT_FALSE(client_.send_pending(0));
  EXPECT_EQ(received(), "hello!");
}

using State = Frame::State;

const std::string get = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
const std::string post = "POST /api/command HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n\r\n{}";

TEST(RequestFrame, ARequestEndsAtTheGivenContentLength) {
  EXPECT_EQ(frame_of(get).state, State::complete);
  EXPECT_EQ(frame_of(get).size, get.size());
  EXPECT_EQ(frame_of(post + "GET").size, post.size());
}

TEST(RequestFrame, ATruncatedRequestIsIncomplete) {
  for (const std::string& whole : {get, post}) {
    for (std::size_t length = 0; length < whole.size(); ++length)
      EXPECT_EQ(frame_of(whole.substr(0, length)).state, State::incomplete) << length;
  }
}

struct Case {
  const char* text;
  int status;
};
class RefusedRequest : public ::testing::TestWithParam<Case> {};

TEST_P(RefusedRequest, HasTheExpectedHttpStatus) {
  const Frame frame = frame_of(std::string(GetParam().text) + "\r\n\r\n");
  EXPECT_EQ(frame.state, State::refused);
  EXPECT_EQ(frame.status, GetParam().status);
}
INSTANTIATE_TEST_SUITE_P(
    RequestFrame, RefusedRequest,
    ::testing::Values(
        Case{"GET", 400}, Case{"GET /", 400}, Case{"GET / HTTP/2.0", 505}, Case{"GET / HTTQ/1.1", 400},
        Case{"GET  / HTTP/1.1", 400}, Case{"GET http://evil/ HTTP/1.1", 400}, Case{"PUT / HTTP/1.1", 405},
        Case{"CONNECT /x HTTP/1.1", 405}, Case{"GET / HTTP/1.1\r\nHost: a\r\nHost: b", 400},
        Case{"GET / HTTP/1.1\r\n folded", 400}, Case{"GET / HTTP/1.1\r\nno colon", 400},
        Case{"GET / HTTP/1.1\r\nbad name: 1", 400}, Case{"GET / HTTP/1.1\r\nX: a\nY: b", 400},
        Case{"GET / HTTP/1.1\r\nX: a\rb", 400}, Case{"GET / HTTP/1.1\r\nX: \x01", 400},
        Case{"GET / HTTP/1.1\r\nX: \xff", 400}, Case{"POST / HTTP/1.1\r\nTransfer-Encoding: chunked", 501},
        Case{"POST / HTTP/1.1\r\nExpect: 100-continue", 417},
        Case{"POST / HTTP/1.1\r\nContent-Encoding: br\r\nContent-Length: 1", 415},
        Case{"POST / HTTP/1.1\r\nCONTENT-encoding:gzip\r\nContent-Length: 1", 415},
        Case{"POST / HTTP/1.1\r\nContent-Encoding : br\r\nContent-Length: 1", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 1", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: -1", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 1, 1", 400}, Case{"POST / HTTP/1.1\r\nContent-Length:", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 16385", 413}));

TEST(RequestFrame, LimitsTheTargetAndTheHeaders) {
  EXPECT_EQ(frame_of("GET /" + std::string(longest_target, 'a') + " HTTP/1.1\r\n\r\n").status, 414);
  EXPECT_EQ(frame_of("GET / HTTP/1.1\r\nX: " + std::string(longest_head, 'a')).status, 431);
  std::string many = "GET / HTTP/1.1\r\n";
  for (std::size_t i = 0; i <= most_headers; ++i) many += "X: 1\r\n";
  EXPECT_EQ(frame_of(many + "\r\n").status, 431);
  EXPECT_EQ(frame_of(std::string("GET /\0 HTTP/1.1", 15)).status, 400)
      << "the request must be refused before the end of its header";
}

/// The fuzz target aborts if a checked property does not hold, and the test then fails.
TEST(RequestFrame, CompleteAndTruncatedFuzzSeedsViolateNoProperty) {
  std::size_t seeds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SOFTGRIP_SOURCE_DIR "/tests/tools/web/web_request_corpus")) {
    const std::string seed = *read_file(entry.path(), 65536);
    EXPECT_EQ(frame_of(seed).state, State::complete) << entry.path();
    for (std::size_t length = 0; length <= seed.size(); ++length)
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(seed.data()), length);
    ++seeds;
  }
  EXPECT_GE(seeds, 4U);
}

}  // namespace
}  // namespace softgrip::web::client_test
