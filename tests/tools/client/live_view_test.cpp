#include "tools/client/live_view.h"

#include <gtest/gtest.h>

#include "tools/client/key_dialogue.h"

namespace softgrip::tools::live_view_test {
namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

Json status_at(double time_s) {
  Json status = Json::parse(R"({"rig": "bench", "rate_hz": 200, "state": "idle",
    "bus": {"board": "ADAM", "connected": true}, "loop": {"ticks": 1, "slips": 0}, "recording": {"active": false},
    "channels": [{"name": "left", "validity": "valid", "result": "-", "health": "healthy", "command_kpa": 0,
      "pressure_kpa": 0.0, "displacement_mm": 0.0,
      "limits": {"pressure_min_kpa": 0, "pressure_max_kpa": 60, "displacement_min_mm": 0, "displacement_max_mm": 25}}]})");
  status["time_s"] = time_s;
  status["channels"][0]["pressure_kpa"] = time_s;
  return status;
}

Json event(int id, const std::string& severity, const std::string& text) {
  return {{"id", id}, {"time_s", 1.5}, {"severity", severity}, {"text", text}};
}

LiveState state() {
  LiveState state;
  for (int second = 0; second <= 30; ++second) update_status(state, status_at(second));
  add_event(state, event(1, "information", "The state is now idle."));
  add_event(state, event(2, "error", "left: Fault F202 reading_out_of_range: The signal was outside."));
  return state;
}

TEST(LiveView, ShowsTrendsEventsAndKeysAtTheBottom) {
  const Lines lines = screen_of(state(), {80, false, false}, 24);
  ASSERT_EQ(lines.size(), 24U);
  EXPECT_EQ(lines[0], "softgrip bench  idle  30.0 s");
  EXPECT_EQ(lines[3], "  pressure      30.00 kPa, command 0.00                 ___...,,,---~~~===***###");
  EXPECT_EQ(lines[10], "1.5 s    The state is now idle.");
  EXPECT_EQ(lines[11], "1.5 s !! left: Fault F202 reading_out_of_range: The signal was outside.");
  EXPECT_EQ(lines[23], std::string(KeyDialogue::help()) + "  trends: 1 column 1 s");
}

TEST(LiveView, ShowsTheKeysAtEveryWindowHeight) {
  for (std::size_t rows = 1; rows < 30; ++rows) {
    for (const std::size_t columns : {60U, 80U, 100U}) {
      const Lines lines = screen_of(state(), {columns, false, false}, rows);
      ASSERT_LE(lines.size(), rows);
      EXPECT_TRUE(lines.back().starts_with(KeyDialogue::help())) << lines.back();
      for (const std::string& line : lines) EXPECT_LE(line.size(), columns);
    }
  }
}

TEST(LiveView, ASmallWindowStatesThatLinesAreHidden) {
  const Lines lines = screen_of(state(), {80, false, false}, 5);
  EXPECT_NE(lines[3].find("more lines: enlarge the window"), std::string::npos) << lines[3];
}

TEST(LiveView, AQuestionReplacesTheLastReplyAboveTheKeys) {
  LiveState asking = state();
  asking.message = {"stopping", Tone::good};
  EXPECT_EQ(screen_of(asking, {80, false, false}, 24)[22], "stopping");
  asking.question = "Start pick_stone? The fingers will move. y: yes, any other key: no";
  EXPECT_EQ(screen_of(asking, {80, false, false}, 24)[22], asking.question);
  const Lines narrow = screen_of(asking, {40, false, false}, 24);
  EXPECT_EQ(narrow[21], "Start pick_stone? The fingers will move.");
  EXPECT_EQ(narrow[22], "  y: yes, any other key: no");
}

TEST(LiveView, AnInvalidReadingLeavesAGapInTheDisplacementTrend) {
  LiveState live = state();
  Json blind = status_at(31);
  blind["channels"][0]["validity"] = "out_of_range";
  blind["channels"][0]["displacement_mm"] = 20;
  update_status(live, blind);
  EXPECT_EQ(live.trends[0].displacement_mm.glyphs(1, 1, false).front(), " ");
  EXPECT_NE(live.trends[0].pressure_kpa.glyphs(1, 1, false).front(), " ");
}

TEST(LiveView, LimitsTheNumberOfEventsAndToleratesMalformedStatus) {
  LiveState live;
  for (int i = 0; i < 1000; ++i) add_event(live, event(i, "warning", "x"));
  EXPECT_EQ(live.events.size(), events_shown);
  update_status(live, Json::parse(R"({"channels": 3, "time_s": "x"})"));
  update_status(live, Json::parse(R"({"channels": [1, null]})"));
  EXPECT_FALSE(screen_of(live, {80, false, false}, 24).empty());
}

}  // namespace
}  // namespace softgrip::tools::live_view_test
