#include "tools/web/request_frame.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace softgrip::web::request_frame_test {
namespace {

using State = Frame::State;

const std::string get = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
const std::string post = "POST /api/command HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n\r\n{}";

TEST(RequestFrame, ARequestEndsWhereItSays) {
  EXPECT_EQ(frame_of(get).state, State::complete);
  EXPECT_EQ(frame_of(get).size, get.size());
  EXPECT_EQ(frame_of(post + "GET").size, post.size());
}

TEST(RequestFrame, WhatHasNotComeYetIsWaitedFor) {
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

TEST_P(RefusedRequest, ByItsStatus) {
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
        Case{"POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 1", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: -1", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 1, 1", 400}, Case{"POST / HTTP/1.1\r\nContent-Length:", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999", 400},
        Case{"POST / HTTP/1.1\r\nContent-Length: 16385", 413}));

TEST(RequestFrame, HeadsHaveABound) {
  EXPECT_EQ(frame_of("GET /" + std::string(longest_target, 'a') + " HTTP/1.1\r\n\r\n").status, 414);
  EXPECT_EQ(frame_of("GET / HTTP/1.1\r\nX: " + std::string(longest_head, 'a')).status, 431);
  std::string many = "GET / HTTP/1.1\r\n";
  for (std::size_t i = 0; i <= most_headers; ++i) many += "X: 1\r\n";
  EXPECT_EQ(frame_of(many + "\r\n").status, 431);
  EXPECT_EQ(frame_of(std::string("GET /\0 HTTP/1.1", 15)).status, 400)
      << "the request must be refused before the end of its header";
}

/// The fuzz target aborts if a checked property does not hold, and the test then fails.
TEST(RequestFrame, TheSeedsOfTheFuzzTargetAreServedWholeAndCutOff) {
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
}  // namespace softgrip::web::request_frame_test
