#include "tools/client/set_option.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace softgrip::tools::set_option_test {
namespace {

TEST(SetOption, AcceptsNamesWithNumbers) {
  const auto arguments = arguments_of({"squeeze_kpa=4", "hold_s=-0.5e1"});
  ASSERT_TRUE(arguments);
  EXPECT_EQ(*arguments, (std::vector<control::Argument>{{"squeeze_kpa", 4}, {"hold_s", -5}}));
  EXPECT_EQ(json_of(*arguments).dump(), R"({"squeeze_kpa":4.0,"hold_s":-5.0})");
}

TEST(SetOption, RefusesMalformedAndRepeatedSettings) {
  for (const char* setting : {"squeeze_kpa", "=4", "squeeze_kpa=", "squeeze_kpa=fast", "squeeze_kpa=4,5",
                              "squeeze_kpa=4 kPa", "squeeze_kpa=nan", "squeeze_kpa=1e999"}) {
    ::testing::internal::CaptureStderr();
    const auto arguments = arguments_of({setting});
    const std::string said = ::testing::internal::GetCapturedStderr();
    ASSERT_FALSE(arguments) << setting;
    EXPECT_EQ(arguments.error(), ExitCode::usage);
    EXPECT_NE(said.find("--set"), std::string::npos) << said;
    if (std::string(setting).find(',') != std::string::npos) {
      EXPECT_NE(said.find("the decimal mark is a point: 4.5"), std::string::npos) << said;
    }
  }
  EXPECT_FALSE(arguments_of({"a=1", "a=1"}));
}

TEST(SetOption, TakesOneSettingPerOption) {
  CLI::App program;
  std::vector<std::string> settings;
  std::string sequence;
  add_set_option(program, settings);
  program.add_option("SEQUENCE", sequence)->required();
  program.parse("--set a=1 --set b=2 pick_stone");
  EXPECT_EQ(settings, (std::vector<std::string>{"a=1", "b=2"}));
  EXPECT_EQ(sequence, "pick_stone");
}

}  // namespace
}  // namespace softgrip::tools::set_option_test
