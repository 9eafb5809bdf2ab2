#include "tools/client/live_view.h"

#include <gtest/gtest.h>

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

/// Returns the request that a key causes. Returns "leave" if the key ends the dialogue, and "" if the key
/// causes no request.
std::string asked(const KeyDialogue::Outcome& outcome) {
  if (outcome.quit) return "leave";
  return outcome.request ? outcome.request->dump() : "";
}

class KeyDialogueTest : public ::testing::Test {
 protected:
  std::string type(std::string_view keys) { return asked(dialogue_.process(keys, time_s_, ran_)); }

  KeyDialogue dialogue_;
  double time_s_ = 100;
  std::string ran_ = "pick_stone";
};

TEST_F(KeyDialogueTest, StopVentAcknowledgeAndQuitNeedNoConfirmation) {
  EXPECT_EQ(type("s"), R"({"command":"stop"})");
  EXPECT_EQ(type("v"), R"({"command":"vent"})");
  EXPECT_EQ(type("a"), R"({"command":"acknowledge"})")
      << "acknowledge moves no finger, so it needs no confirmation";
  EXPECT_EQ(type("q"), "leave");
  EXPECT_EQ(type("\x04"), "leave");
  EXPECT_EQ(type("x"), "");
}

TEST_F(KeyDialogueTest, AVentIsSentAlsoIfItFollowsAnotherKeyInOneRead) {
  for (const char* const keys : {"sv", "av", "rv", "svv"})
    EXPECT_EQ(type(keys), R"({"command":"vent"})") << keys;
  EXPECT_EQ(type("qv"), "leave");
  EXPECT_EQ(type("vs"), R"({"command":"vent"})");
}

TEST_F(KeyDialogueTest, ReleaseNeedsConfirmation) {
  EXPECT_EQ(type("r"), "");
  EXPECT_NE(dialogue_.question().find("held parts drop"), std::string::npos);
  EXPECT_EQ(type("n"), "");
  EXPECT_TRUE(dialogue_.question().empty());
  EXPECT_EQ(type("y"), "") << "the question must have ended";
  type("r");
  EXPECT_EQ(type("y"), R"({"command":"release"})");
}

TEST_F(KeyDialogueTest, StartProposesTheLastSequenceAndAcceptsAnotherName) {
  EXPECT_EQ(type("g"), "");
  EXPECT_EQ(dialogue_.question(), "start which sequence [pick_stone]? _");
  EXPECT_EQ(type("\r"), "");
  EXPECT_EQ(dialogue_.question(), "Start pick_stone? The fingers will move. y: yes, any other key: no");
  EXPECT_EQ(type("y"), R"({"command":"start","sequence":"pick_stone"})");
  type("g");
  type("hand_ovr");
  type("\x7f");
  type("er");
  EXPECT_EQ(dialogue_.question(), "start which sequence [pick_stone]? hand_over_")
      << "backspace has removed one character";
  type("\x15");
  type("empty_grip\n");
  EXPECT_EQ(type("y"), R"({"command":"start","sequence":"empty_grip"})");
  ran_.clear();
  type("g");
  EXPECT_EQ(type("\r"), "") << "without the name of a sequence, the key starts no sequence";
  EXPECT_TRUE(dialogue_.question().empty());
}

TEST_F(KeyDialogueTest, PastedTextDoesNotConfirmAQuestion) {
  EXPECT_EQ(type("gpick_stone\ryyyy"), "");
  EXPECT_NE(dialogue_.question().find("Start pick_stone?"), std::string::npos);
  EXPECT_EQ(type("n"), "");
  EXPECT_EQ(type("ry"), "");
  EXPECT_FALSE(dialogue_.question().empty());
}

TEST_F(KeyDialogueTest, AQuestionWithoutAnAnswerExpires) {
  type("r");
  time_s_ += KeyDialogue::confirmation_timeout_s + 0.1;
  EXPECT_EQ(type("y"), "");
  type("r");
  EXPECT_FALSE(dialogue_.expire(time_s_ + 1));
  EXPECT_TRUE(dialogue_.expire(time_s_ + 11));
  EXPECT_TRUE(dialogue_.question().empty());
}

TEST_F(KeyDialogueTest, TheStopKeyStopsWhileAConfirmationIsPending) {
  type("r");
  EXPECT_EQ(type("s"), R"({"command":"stop"})");
  EXPECT_TRUE(dialogue_.question().empty());
  type("g");
  EXPECT_EQ(type("s"), "") << "the key is part of the name of the sequence";
  EXPECT_EQ(type("\x1b"), "") << "Escape ends the question";
  EXPECT_TRUE(dialogue_.question().empty());
}

TEST_F(KeyDialogueTest, ArrowKeysCauseNoRequest) {
  EXPECT_EQ(type("\x1b[A"), "");
  EXPECT_EQ(type("\x1bOs"), "");
  EXPECT_LE(KeyDialogue::help().size(), 60U);
}

}  // namespace

}  // namespace softgrip::tools::live_view_test
