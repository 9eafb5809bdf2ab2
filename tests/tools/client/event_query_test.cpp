#include "tools/client/event_query.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tools/client/daemon_text.h"

namespace softgrip::tools::event_query_test {
namespace {

using Json = nlohmann::ordered_json;

class EventQueryTest : public ::testing::Test {
 protected:
  EventQueryTest() {
    ::setenv("TZ", "UTC-1", 1);  // local time is UTC + 1 h
    ::tzset();
  }
  static std::string since(const std::string& text) {
    constexpr Nanoseconds now = 1'763'610'372 * ns_per_s;  // 2025-11-20 03:46:12 UTC, which is 04:46:12 local
                                                           // time
    const auto parsed = parse_since(text, now);
    return !parsed ? "refused" : parsed->at.empty() ? std::to_string(parsed->id) : parsed->at;
  }
};

TEST_F(EventQueryTest, SinceAcceptsAnEventIdADurationOrATime) {
  EXPECT_EQ(since("1234"), "1234");
  EXPECT_EQ(since("90s"), "2025-11-20T03:44:42.000Z");
  EXPECT_EQ(since("10min"), "2025-11-20T03:36:12.000Z");
  EXPECT_EQ(since("2h"), "2025-11-20T01:46:12.000Z");
  EXPECT_EQ(since("1d"), "2025-11-19T03:46:12.000Z");
  EXPECT_EQ(since("04:15"), "2025-11-20T03:15:00.000Z");
  EXPECT_EQ(since("2025-11-19"), "2025-11-18T23:00:00.000Z");
  EXPECT_EQ(since("2025-11-19 10:15:30"), "2025-11-19T09:15:30.000Z");
  for (const char* nonsense :
       {"", "yesterday", "10 parsec", "25:70", "2026-02-31", "12345678901234567890", "9999999d", "200000d"}) {
    EXPECT_EQ(since(nonsense), "refused") << nonsense;
  }
}

TEST_F(EventQueryTest, SelectsEventsByIdSeverityAndTime) {
  const Json event{{"id", 7}, {"severity", "warning"}, {"at", "2025-11-20T03:46:12.000Z"}};
  EXPECT_TRUE(matches({}, event));
  EXPECT_TRUE(matches({{6, ""}, "warning", 1}, event));
  EXPECT_FALSE(matches({{7, ""}, "information", 1}, event));
  EXPECT_FALSE(matches({{0, ""}, "error", 1}, event));
  EXPECT_TRUE(matches({{0, "2025-11-20T03:46:12.000Z"}, "information", 1}, event));
  EXPECT_FALSE(matches({{0, "2025-11-20T03:46:12.001Z"}, "information", 1}, event));
}

TEST_F(EventQueryTest, AGapInTheIdsIsTheNumberOfMissingEvents) {
  EXPECT_EQ(missing_before({{"id", 8}}, 7), 0U);
  EXPECT_EQ(missing_before({{"id", 11}}, 7), 3U);
  EXPECT_EQ(missing_before({{"id", 11}}, 0), 0U) << "the first event that a client receives";
  EXPECT_EQ(missing_before({{"id", 7}}, 7), 0U);
  EXPECT_EQ(missing_before(Json::object(), 7), 0U);
}

TEST_F(EventQueryTest, AnEventLineShowsTheLocalTimeIfTheEventHasADate) {
  Json event{{"time_s", 12.34}, {"severity", "error"}, {"text", "The board is gone."}};
  EXPECT_EQ(line_of_event(event), "     12.340 s  error        The board is gone.");
  event["at"] = "2025-11-20T03:46:12.045Z";
  EXPECT_EQ(line_of_event(event), "2025-11-20 04:46:12.045  error        The board is gone.");
}

}  // namespace
}  // namespace softgrip::tools::event_query_test
