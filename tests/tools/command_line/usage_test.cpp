#include "tools/command_line/program.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "tools/command_line/options.h"

namespace softgrip::tools::usage_test {
namespace {

struct Said {
  int code = 0;
  std::string text;
};

Said said_of(std::vector<std::string> words) {
  CLI::App program{"A tool", "tool"};
  program.require_subcommand(1);
  bool flag = false;
  program.add_subcommand("status", "Now")->add_flag("--json", flag, "As JSON");
  program.add_subcommand("start", "Go");
  CLI::App* const study = program.add_subcommand("study", "Study");
  study->require_subcommand(1);
  int seed = 0;
  study->add_subcommand("published", "One")
      ->add_option("--seed", seed, "Seed")
      ->check(whole_between(0, 65535));
  words.insert(words.begin(), "tool");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  const int count = static_cast<int>(arguments.size());
  Said said;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  try {
    program.parse(count, arguments.data());
  } catch (const CLI::ParseError& error) {
    said.code = end_of(program, error, count, arguments.data());
  }
  said.text = ::testing::internal::GetCapturedStderr() + ::testing::internal::GetCapturedStdout();
  return said;
}

TEST(Usage, SuggestsTheNearestCommandForAMistypedOne) {
  const Said said = said_of({"statsu"});
  EXPECT_EQ(said.code, 2);
  EXPECT_NE(said.text.find("there is no command `statsu`; did you mean `status`?"), std::string::npos)
      << said.text;
  EXPECT_EQ(said_of({"fly"}).text.find("did you mean"), std::string::npos);
  EXPECT_NE(said_of({"statsu", "--json"}).text.find("did you mean `status`?"), std::string::npos);
}

TEST(Usage, ControlCharactersOfAWordAreNotPrinted) {
  const Said said = said_of({"status", "--a\x1b[2J"});
  EXPECT_EQ(said.code, 2);
  EXPECT_NE(said.text.find("--a\\x1b[2J"), std::string::npos) << said.text;
  EXPECT_EQ(said.text.find('\x1b'), std::string::npos);
}

TEST(Usage, SuggestsACommandThatMovesARigOnlyIfNoOtherNameIsSimilar) {
  EXPECT_NE(said_of({"stat"}).text.find("did you mean `status`?"), std::string::npos)
      << said_of({"stat"}).text;
  EXPECT_NE(said_of({"sta"}).text.find("did you mean `status`?"), std::string::npos);
  EXPECT_NE(said_of({"star"}).text.find("did you mean `start`?"), std::string::npos);
  EXPECT_EQ(said_of({"st"}).text.find("did you mean"), std::string::npos)
      << "2 letters are too few for a suggestion";
}

TEST(Usage, SuggestsTheNearestOptionOfTheCommand) {
  const Said said = said_of({"status", "--jsno"});
  EXPECT_EQ(said.code, 2);
  EXPECT_NE(said.text.find("--jsno: did you mean `--json`?"), std::string::npos) << said.text;
  EXPECT_EQ(said_of({"start", "--jsno"}).text.find("--json"), std::string::npos)
      << "the command `start` has no option with this name";
}

TEST(Usage, SuggestsTheNearestCommandOfACommand) {
  const Said said = said_of({"study", "publishd"});
  EXPECT_EQ(said.code, 2);
  EXPECT_NE(said.text.find("tool study: there is no command `publishd`; did you mean `published`?"),
            std::string::npos)
      << said.text;
}

TEST(Usage, AWrongWholeNumberStatesThePermittedRange) {
  for (const char* text : {"many", "70000", "-1", "1.5", "65536"}) {
    const Said said = said_of({"study", "published", "--seed", text});
    EXPECT_EQ(said.code, 2);
    EXPECT_NE(said.text.find("'" + std::string(text) + "' is not a whole number from 0 to 65535"),
              std::string::npos)
        << said.text;
  }
  EXPECT_EQ(said_of({"study", "published", "--seed", "65535"}).code, 0);
}

TEST(Usage, HelpIsNoError) {
  EXPECT_EQ(said_of({"--help"}).code, 0);
  EXPECT_EQ(said_of({"status", "--help"}).code, 0);
  EXPECT_EQ(said_of({}).code, 2);
}

}  // namespace
}  // namespace softgrip::tools::usage_test
