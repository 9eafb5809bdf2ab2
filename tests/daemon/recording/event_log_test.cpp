#include "daemon/recording/event_log.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/recording/run_json.h"

namespace softgrip::daemon::event_log_test {
namespace {

control::Event started() {
  control::Event event;
  event.kind = control::Event::Kind::sequence_started;
  event.request = 7;
  return event;
}

TEST(EventLog, AStartEventNamesSequenceAndParameters) {
  control::PreparedSequence sequence;
  sequence.name = "pick_stone";
  EXPECT_EQ(describe(started(), {}, &sequence).text, "The sequence 'pick_stone' begins.");
  EXPECT_TRUE(describe(started(), {}, &sequence).parameters.empty());
  sequence.parameters = {{"squeeze_kpa", 4}, {"hold_s", 0.5}};
  const EventEntry entry = describe(started(), {}, &sequence);
  EXPECT_EQ(entry.text, "The sequence 'pick_stone' begins with squeeze_kpa 4, hold_s 0.5.");
  EXPECT_EQ(entry.parameters, sequence.parameters);
  EXPECT_EQ(entry.request, 7U);
}

TEST(EventLog, ARefusedResetGivesTheNumberOfTheCause) {
  control::EventList events;
  events.add_of_channel<control::Event::Kind::request_refused>(
      1, {control::RefusalCode::cause_persists, control::FaultCode::reading_out_of_range}, 8);
  const EventEntry entry = describe(*events.begin(), {"left", "right"}, nullptr);
  EXPECT_EQ(entry.code, "R09");
  EXPECT_EQ(entry.value, 202);
  EXPECT_EQ(entry.channel, "right");
  EXPECT_NE(entry.text.find("F202 reading_out_of_range"), std::string::npos) << entry.text;
}

TEST(EventLog, AnotherClientIsAWarningWithTheClientCount) {
  BusEvent event;
  event.kind = BusEvent::Kind::another_client;
  event.detail = {'2'};
  const EventEntry entry = describe(event);
  EXPECT_EQ(entry.kind, "another_client");
  EXPECT_EQ(entry.severity, Severity::warning);
  EXPECT_NE(entry.text.find("has 2 clients"), std::string::npos) << entry.text;
}

TEST(EventLog, AFailedConnectionEventStatesTheReason) {
  BusEvent event;
  event.kind = BusEvent::Kind::not_connected;
  event.status = drivers::BusStatus::disconnected;
  event.detail = {'g', 'o', 'n', 'e'};
  const EventEntry entry = describe(event);
  EXPECT_EQ(entry.kind, "bus_not_connected");
  EXPECT_EQ(entry.code, "disconnected");
  EXPECT_EQ(entry.text, "No session with the board can be opened: disconnected: gone.");
}

TEST(EventLog, IdsAreConsecutiveAndTheOldestEntriesAreRemoved) {
  EventLog log(3);
  EXPECT_EQ(log.oldest(), 0U);
  EXPECT_TRUE(log.since(0, 10).empty());
  for (int i = 0; i < 5; ++i) log.add({});
  EXPECT_EQ(log.oldest(), 3U);
  EXPECT_EQ(log.newest(), 5U);
  const auto ids = [&](std::uint64_t since, std::size_t limit) {
    std::vector<std::uint64_t> found;
    for (const EventEntry& entry : log.since(since, limit)) found.push_back(entry.id);
    return found;
  };
  EXPECT_EQ(ids(0, 10), (std::vector<std::uint64_t>{3, 4, 5}));
  EXPECT_EQ(ids(3, 1), (std::vector<std::uint64_t>{4}));
  EXPECT_EQ(ids(4, 10), (std::vector<std::uint64_t>{5}));
  EXPECT_TRUE(ids(5, 10).empty());
  EXPECT_TRUE(ids(99, 10).empty());
}

TEST(EventLog, CountsIncludeRemovedEntriesAndIgnoreSequenceNames) {
  EventLog log(2);
  EventEntry result;
  result.kind = "grip_result";
  result.code = "HOLDING";
  result.channel = "left";
  for (int i = 0; i < 5; ++i) log.add(result);
  result.channel = "right";
  log.add(result);
  for (const char* name : {"a", "b", "c"}) {
    EventEntry start;
    start.kind = "sequence_started";
    start.code = name;
    log.add(start);
  }
  const std::vector<EventCount> counts = log.counts();
  ASSERT_EQ(counts.size(), 3U);
  EXPECT_EQ(counts[0].channel, "left");
  EXPECT_EQ(counts[0].code, "HOLDING");
  EXPECT_EQ(counts[0].count, 5U);
  EXPECT_EQ(counts[1].channel, "right");
  EXPECT_EQ(counts[1].count, 1U);
  EXPECT_EQ(counts[2].kind, "sequence_started");
  EXPECT_EQ(counts[2].code, "");
  EXPECT_EQ(counts[2].count, 3U);
}

TEST(RunJson, ContainsTheParametersOfTheSequence) {
  auto loaded = std::make_shared<LoadedSequence>();
  loaded->prepared.name = "pick_stone";
  loaded->prepared.parameters = {{"squeeze_kpa", 4}};
  RunStory story;
  story.sequence = loaded;
  story.events.push_back(describe(started(), {}, &loaded->prepared));
  const auto json = nlohmann::json::parse(run_json({}, story));
  EXPECT_EQ(json["sequence"]["parameters"], nlohmann::json({{"squeeze_kpa", 4.0}}));
  EXPECT_EQ(json["events"][0]["parameters"], nlohmann::json({{"squeeze_kpa", 4.0}}));
}

}  // namespace
}  // namespace softgrip::daemon::event_log_test
