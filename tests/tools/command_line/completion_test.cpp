#include "tools/command_line/command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace softgrip::tools::completion_test {
namespace {

/// Tests with a program that has options of all kinds that a completion script must support.
class Completion : public ::testing::Test {
 protected:
  Completion() {
    CLI::App* events = program_.add_subcommand("events", "What it's [about]: all");
    events->add_option("-n,--lines", text_, "How many");
    events->add_option("--severity", text_, "Which")->check(CLI::IsMember({"warning", "error"}));
    events->add_flag("--json", flag_, "As JSON");
    CLI::App* start = program_.add_subcommand("start", "Starts");
    start->add_option("SEQUENCE", text_, "A name");
    start->add_option("--socket", text_, "Where");
    CLI::App* study = program_.add_subcommand("study", "Studies");
    study->add_subcommand("control", "One")->add_option("--out", text_, "To");
    study->add_subcommand("published", "Other")->add_option("--out", text_, "To");
  }
  /// Returns the words that bash offers to complete the last of these words.
  std::string offered(const std::vector<std::string>& words) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    const std::string script = folder / ("completion_" + std::to_string(::getpid()));
    std::ofstream(script) << completion_script(program_, Shell::bash) << "tool() { echo from_daemon; }\n"
                          << "COMP_WORDS=(" << joined(words) << ")\nCOMP_CWORD=" << words.size() - 1
                          << "\ncd /nonexistent 2>/dev/null; cd /\n_tool\necho \"${COMPREPLY[*]}\" >"
                          << script << ".out\n";
    EXPECT_EQ(std::system(("bash " + script).c_str()), 0);
    std::string line;
    std::ifstream out(script + ".out");
    std::getline(out, line);
    std::filesystem::remove(script);
    std::filesystem::remove(script + ".out");
    return line;
  }
  static std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += "'" + word + "' ";
    return text;
  }

  CLI::App program_{"A tool", "tool"};
  std::string text_;
  bool flag_ = false;
};

TEST_F(Completion, BashCompletesCommandsOptionsAndValues) {
  EXPECT_EQ(offered({"tool", "s"}), "start study");
  EXPECT_EQ(offered({"tool", "events", "--"}), "--help --lines --severity --json");
  EXPECT_EQ(offered({"tool", "events", "--severity", ""}), "warning error");
  EXPECT_EQ(offered({"tool", "events", "--severity", "e"}), "error");
  EXPECT_EQ(offered({"tool", "events", "-n", ""}), "") << "readline completes file names";
  EXPECT_EQ(offered({"tool", "start", "from"}), "from_daemon");
  EXPECT_EQ(offered({"tool", "study", ""}), "control published");
  EXPECT_EQ(offered({"tool", "study", "control", "--o"}), "--out")
      << "an option of two commands must be offered only once";
  EXPECT_EQ(offered({"tool", "--he"}), "--help");
}

TEST_F(Completion, OtherShellsGetTheSameWords) {
  const std::string zsh = completion_script(program_, Shell::zsh);
  EXPECT_NE(zsh.find("'events:What it'\\''s [about]\\: all'"), std::string::npos) << zsh;
  EXPECT_NE(zsh.find("'--severity[Which]:word:(warning error)'"), std::string::npos) << zsh;
  EXPECT_NE(zsh.find("tool sequences --names"), std::string::npos) << zsh;
  const std::string fish = completion_script(program_, Shell::fish);
  EXPECT_NE(fish.find("-l severity -x -a 'warning error' -d 'Which'"), std::string::npos) << fish;
  EXPECT_NE(fish.find("-a events -d 'What it\\'s [about]: all'"), std::string::npos) << fish;
}

TEST(ShellNamed, FindsZshAndRefusesCsh) {
  EXPECT_EQ(shell_named("zsh"), Shell::zsh);
  EXPECT_FALSE(shell_named("csh"));
}

}  // namespace
}  // namespace softgrip::tools::completion_test
