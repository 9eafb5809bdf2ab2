#include "tools/client/key_dialogue.h"

#include <gtest/gtest.h>

namespace softgrip::tools::key_dialogue_test {
namespace {

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
}  // namespace softgrip::tools::key_dialogue_test
