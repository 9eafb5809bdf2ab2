#include "daemon/socket/client_request.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace softgrip::daemon::client_request_test {
namespace {

using Command = ClientRequest::Command;

std::string problem_of(const std::string& line) {
  const auto request = parse_client_request(line);
  return request ? "" : request.error().message;
}

TEST(ClientRequest, ReadsEveryCommand) {
  const std::vector<std::pair<std::string, Command>> lines{
      {R"({"command":"status"})", Command::status},
      {R"({"command":"watch","rate_hz":25})", Command::watch},
      {R"({"command":"unwatch"})", Command::unwatch},
      {R"({"command":"start","sequence":"a"})", Command::start},
      {R"({"command":"stop"})", Command::stop},
      {R"({"command":"vent"})", Command::vent},
      {R"({"command":"release"})", Command::release},
      {R"({"command":"acknowledge"})", Command::acknowledge},
      {R"({"command":"events","since":5,"limit":10})", Command::events},
      {R"({"command":"statistics","histograms":true})", Command::statistics},
      {R"({"command":"sequences"})", Command::sequences},
      {R"({"command":"hello","client":"cell 4","api":1})", Command::hello},
      {R"({"command":"subscribe","since":0,"started_at":"2026"})", Command::subscribe},
      {R"({"command":"unsubscribe"})", Command::unsubscribe},
  };
  for (const auto& [line, command] : lines) {
    const auto request = parse_client_request(line);
    ASSERT_TRUE(request) << line << ": " << problem_of(line);
    EXPECT_EQ(request->command, command);
    EXPECT_FALSE(request->id.has_value());
  }
}

TEST(ClientRequest, ReadsArguments) {
  const auto watch = parse_client_request(R"({"id":7,"command":"watch","rate_hz":2.5})");
  ASSERT_TRUE(watch);
  EXPECT_EQ(watch->id, 7U);
  EXPECT_EQ(watch->rate_hz, 2.5);
  const auto start =
      parse_client_request(R"({"command":"start","sequence":"s","sequence_text":"name: x\n"})");
  ASSERT_TRUE(start);
  EXPECT_EQ(start->sequence, "s");
  EXPECT_EQ(start->sequence_text, "name: x\n");
  const auto asked = parse_client_request(
      R"({"command":"start","sequence":"s","parameters":{"squeeze_kpa":4,"hold_s":0.5}})");
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->parameters, (std::vector<control::Argument>{{"hold_s", 0.5}, {"squeeze_kpa", 4}}));
  const auto named = parse_client_request(R"({"command":"start","sequence":"s","start_id":"cell 4/17"})");
  ASSERT_TRUE(named);
  EXPECT_EQ(named->start_id, "cell 4/17");
  EXPECT_EQ(parse_client_request(R"({"command":"stop","start_id":"cell 4/17"})")->start_id, "cell 4/17");
  EXPECT_EQ(parse_client_request(R"({"command":"stop","request":4294967295})")->request, 4294967295U);
  EXPECT_EQ(parse_client_request(R"({"command":"stop"})")->request, std::nullopt);
  const auto events = parse_client_request(R"({"id":9007199254740992,"command":"events","since":12})");
  ASSERT_TRUE(events);
  EXPECT_EQ(events->id, 9007199254740992U);
  EXPECT_EQ(events->since, 12U);
  EXPECT_EQ(events->limit, 100U);
}

TEST(ClientRequest, EveryInvalidRequestIsRefusedWithTheReason) {
  const std::vector<std::pair<std::string, std::string>> lines{
      {"", "not a JSON object"},
      {"status", "not a JSON object"},
      {"[]", "not a JSON object"},
      {"5", "not a JSON object"},
      {R"({"command":"status")", "not a JSON object"},
      {R"({"command":"status"}{})", "not a JSON object"},
      {"{\"command\":\"st\xff\"}", "not a JSON object"},
      {R"({"command":"status","command":"stop"})", "appears twice"},
      {R"({"command":{"a":1}})", "flat"},
      {R"({"command":"status","x":[[[1]]]})", "flat"},
      {"{}", "'command' is missing"},
      {R"({"command":5})", "'command' must be a text"},
      {R"({"command":null})", "'command' is null"},
      {R"({"command":"fly"})", "no command 'fly'"},
      {R"({"command":"status","rate_hz":5})", "has no key 'rate_hz'"},
      {R"({"command":"start"})", "needs the key 'sequence'"},
      {R"({"command":"start","sequence":""})", "'sequence' must be a text"},
      {R"({"command":"start","sequence_text":"a"})", "needs the key 'sequence'"},
      {R"({"command":"watch","rate_hz":0})", "'rate_hz' must be a number from"},
      {R"({"command":"watch","rate_hz":1e999})", ""},
      {R"({"command":"watch","rate_hz":"10"})", "'rate_hz' must be a number from"},
      {R"({"id":-1,"command":"status"})", "'id' must be a whole number"},
      {R"({"id":1.5,"command":"status"})", "'id' must be a whole number"},
      {R"({"id":18446744073709551615,"command":"status"})", "'id' must be a whole number"},
      {R"({"command":"events","limit":0})", "'limit' must be a whole number"},
      {R"({"command":"events","limit":1001})", "'limit' must be a whole number"},
      {R"({"command":"start","sequence":"s","parameters":{"a":"4"}})", "the parameter 'a' must be a number"},
      {R"({"command":"start","sequence":"s","parameters":{"a":4,"a":5}})", "appears twice"},
      {R"({"command":"start","sequence":"s","parameters":{"a":{"b":5}}})", "flat"},
      {R"({"command":"start","sequence":"s","parameters":{"parameters":{"b":5}}})", "flat"},
      {R"({"command":"start","sequence":"s","parameters":[4]})", "flat"},
      {R"({"command":"start","sequence":"s","parameters":4})", "'parameters' must be an object"},
      {R"({"command":"stop","parameters":{}})", "has no key 'parameters'"},
      {R"({"command":"statistics","histograms":1})", "'histograms' must be true or false"},
      {R"({"command":"start","sequence":"s","dry_run":1})", "'dry_run' must be true or false"},
      {R"({"command":"stop","dry_run":true})", "has no key 'dry_run'"},
      {R"({"command":"stop","request":0})", "'request' must be a whole number from 1 to 4294967295"},
      {R"({"command":"stop","request":4294967296})", "'request' must be a whole number from 1 to 4294967295"},
      {R"({"command":"stop","start_id":""})", "'start_id' must be a text"},
      {R"({"command":"stop","start_id":"a\nb"})", "'start_id' must have at most 64 bytes"},
      {R"({"command":"stop","request":3,"start_id":"a"})", "not both"},
      {R"({"command":"vent","start_id":"a"})", "has no key 'start_id'"},
      {R"({"command":"start","sequence":"s","dry_run":true,"start_id":"a"})", "a dry run starts nothing"},
      {R"({"command":"hello","client":"a\nb"})", "'client' must have at most 64 bytes"},
      {R"({"command":"hello","client":"a\u007fb"})", "no control characters"},
      {R"({"command":"hello","client":"\u0080"})", "no control characters"},
      {R"({"command":"hello","client":"\u009b31m"})", "no control characters"},
      {R"({"command":"stop","start_id":"\u009f"})", "no control characters"},
      {R"({"command":"hello","api":0})", "'api' must be a whole number"},
      {R"({"command":"subscribe","since":-1})", "'since' must be a whole number"},
  };
  for (const auto& [line, part] : lines) {
    const auto request = parse_client_request(line);
    EXPECT_FALSE(request) << line;
    EXPECT_NE(problem_of(line).find(part), std::string::npos) << line << ": " << problem_of(line);
  }
}

TEST(ClientRequest, ReadOnlyClientsLackTheFiveControlCommands) {
  const auto all = commands_of(Role::operate);
  const auto looking = commands_of(Role::look);
  EXPECT_EQ(all.size(), looking.size() + 5);
  for (const std::string_view moves : {"start", "stop", "vent", "release", "acknowledge"}) {
    EXPECT_EQ(std::count(all.begin(), all.end(), moves), 1) << moves;
    EXPECT_EQ(std::count(looking.begin(), looking.end(), moves), 0) << moves;
  }
}

TEST(ClientRequest, AClientNameHasAtMost64Characters) {
  const auto hello = [](std::size_t letters) {
    return R"({"command":"hello","client":")" + std::string(letters, 'x') + R"("})";
  };
  EXPECT_TRUE(parse_client_request(hello(64)));
  EXPECT_FALSE(parse_client_request(hello(65)));
  EXPECT_EQ(parse_client_request(R"({"command":"subscribe"})")->since, std::nullopt);
  EXPECT_EQ(parse_client_request(R"({"command":"hello","client":"Zelle \u00a0\u00e4 \\ 4"})")->client,
            "Zelle \u00a0\u00e4 \\ 4");
}

TEST(ClientRequest, AnErrorContainsTheIdOfTheRequest) {
  const auto request = parse_client_request(R"({"id":3,"command":"fly"})");
  ASSERT_FALSE(request);
  EXPECT_EQ(request.error().id, 3U);
  for (const char* invalid : {"-1", "1.5", "9007199254740993", "null", R"("a")"}) {
    const auto refused = parse_client_request(fmt::format(R"({{"id":{},"command":"status"}})", invalid));
    ASSERT_FALSE(refused) << invalid;
    EXPECT_EQ(refused.error().id, std::nullopt) << invalid;
  }
}

TEST(ClientRequest, DeeplyNestedJsonIsRefused) {
  std::string line = R"({"command":)";
  line += std::string(60'000, '[');
  EXPECT_FALSE(parse_client_request(line));
}

// Parses the corpus of the fuzz target in every build. Each line is parsed complete, cut off at every byte,
// and with every byte changed.
TEST(ClientRequest, TheFuzzCorpusCausesNoFailure) {
  const auto feed = [](const std::string& line) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
  };
  std::size_t files = 0;
  const std::filesystem::path folder =
      std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "tests/daemon/socket/client_request_corpus";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string line = test::text_of(entry.path());
    feed(line);
    for (std::size_t i = 0; i < line.size(); ++i) {
      feed(line.substr(0, i));
      for (const char byte : {'\0', '"', '[', '}', '9', '\xff'}) {
        std::string damaged = line;
        damaged[i] = byte;
        feed(damaged);
      }
    }
    ++files;
  }
  EXPECT_GE(files, 13U);
}

}  // namespace
}  // namespace softgrip::daemon::client_request_test
