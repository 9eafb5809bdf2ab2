#include "tools/command_line/command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace softgrip::tools::call_test {
namespace {

TEST(Call, ListsTheGivenOptionsWithoutThoseForTheOutput) {
  CLI::App program;
  CLI::App* command = program.add_subcommand("fit", "");
  std::vector<std::string> data;
  std::string out, start;
  int seed = 1;
  bool robust = false, json = false, held = false;
  command->add_option("--data", data)->required();
  command->add_option("--out", out);
  command->add_option("--start", start);
  command->add_option("--seed", seed);
  command->add_flag("--robust", robust);
  command->add_flag("--held", held);
  command->add_flag("--json", json);
  program.parse("fit --robust --data a.csv b.csv --out o --seed 7 --json");
  const std::vector<std::string> wanted{"fit", "--data", "a.csv", "b.csv", "--seed", "7", "--robust"};
  EXPECT_EQ(call_of(*command), wanted);
}

}  // namespace
}  // namespace softgrip::tools::call_test
