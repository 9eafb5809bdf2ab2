#include "tools/web/live_state.h"

#include <gtest/gtest.h>

#include "tests/tools/daemon_lines.h"
#include "tools/client/daemon_client.h"
#include "tools/web/metrics/metrics.h"

namespace softgrip::web::live_state_test {
namespace {

using Json = nlohmann::ordered_json;

Json status_at(double time_s) {
  return {{"time_s", time_s},
          {"channels", {{{"name", "left"}, {"command_kpa", 1}, {"displacement_mm", time_s}}}}};
}

Json snapshot_of(const LiveState& state) {
  const std::string text = state.snapshot_message();
  constexpr std::string_view begin = "event: hello\ndata: ";
  EXPECT_TRUE(text.starts_with(begin) && text.ends_with("\n\n"));
  return Json::parse(text.substr(begin.size()));
}

TEST(LiveState, KeepsTheLastMinute) {
  LiveState state;
  for (int i = 0; i <= 500; ++i) state.set_status(status_at(i * 0.2));
  const Json trend = snapshot_of(state)["trend"];
  EXPECT_EQ(trend.front()[0], 40.0);
  EXPECT_EQ(trend.back()[0], 100.0);
  EXPECT_EQ(trend.back()[1], Json({1, nullptr, 100.0, nullptr}));
  state.set_status(status_at(0.5));
  EXPECT_EQ(snapshot_of(state)["trend"].size(), 1U) << "the trend must begin again with a new daemon";
}

TEST(LiveState, SendsEachMessageOnceAndLimitsUnreadMessages) {
  LiveState state;
  EXPECT_EQ(state.take_messages(), "");
  state.set_status(status_at(1));
  state.add_event({{"id", 1}, {"text", "a\nb"}});
  const std::string messages = state.take_messages();
  EXPECT_TRUE(messages.starts_with("event: state\ndata: {\"time_s\":1.0")) << messages;
  EXPECT_TRUE(messages.ends_with("event: happened\ndata: {\"id\":1,\"text\":\"a\\nb\"}\n\n")) << messages;
  EXPECT_EQ(state.take_messages(), "");
  for (int i = 0; i < 100000; ++i) state.add_event({{"id", i}, {"text", std::string(50, 'x')}});
  EXPECT_LT(state.take_messages().size(), 2U << 20U);
  EXPECT_EQ(snapshot_of(state)["events"].size(), LiveState::events_kept);
}

TEST(LiveState, ClearsTheStatusWithoutADaemonButKeepsTheEvents) {
  LiveState state;
  state.set_status(status_at(1));
  state.set_statistics({{"loop", {}}});
  state.add_event({{"id", 1}});
  static_cast<void>(state.take_messages());
  state.clear_live_data();
  EXPECT_EQ(state.take_messages(), "event: state\ndata: null\n\n");
  EXPECT_TRUE(state.statistics().is_null());
  EXPECT_EQ(snapshot_of(state)["events"].size(), 1U) << "earlier events remain";
  state.clear_live_data();
  EXPECT_EQ(state.take_messages(), "");
}

TEST(LiveState, EveryAcceptedReplyIsProcessedWithoutException) {
  LiveState state;
  for (const Json& good : tools::testing::good_lines()) {
    for (const Json& bad : tools::testing::damaged(good)) {
      const auto parsed = tools::parse_reply(bad.dump());
      if (!parsed) continue;
      if (parsed->contains("watch")) {
        EXPECT_NO_THROW(state.set_status(parsed->at("watch"))) << bad;
      }
      if (parsed->contains("event")) {
        EXPECT_NO_THROW(state.add_event(parsed->at("event"))) << bad;
      }
      if (parsed->contains("result")) {
        EXPECT_NO_THROW(state.set_statistics(parsed->at("result"))) << bad;
      }
      MetricText metrics;
      EXPECT_NO_THROW(add_daemon_metrics(state.status(), state.statistics(), metrics)) << bad;
      EXPECT_NO_THROW(static_cast<void>(state.snapshot_message())) << bad;
      static_cast<void>(state.take_messages());
    }
  }
}

}  // namespace
}  // namespace softgrip::web::live_state_test
