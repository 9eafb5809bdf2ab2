#include "control/sequences/parameters.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "control/sequences/sequence_file.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control::parameters_test {
namespace {

constexpr const char* declared =
    "name: x\n"
    "parameters:\n"
    "  level_kpa: {default: 20, range: [10, 40], about: how hard}\n"
    "  rounds: {unit: none, default: 2, range: [1, 5], about: how often}\n";
constexpr const char* steps =
    "steps:\n"
    "  - move: {pressure_kpa: $level_kpa, duration_s: 1, pressure_max_kpa: 50}\n"
    "  - pressure: {signal: tp1, cycles: $rounds}\n";

std::optional<Sequence> read(const std::string& text, document::Problems& problems,
                             const std::vector<Argument>& arguments = {}) {
  return read_sequence(document::parse("seq.yaml", text, problems), problems, arguments);
}

TEST(Parameters, ParameterValuesReplaceNumbersInSteps) {
  document::Problems problems;
  const auto plain = read(std::string(declared) + steps, problems);
  ASSERT_TRUE(plain) << problems.format();
  EXPECT_EQ(plain->steps[0].target.value, 20);
  EXPECT_EQ(plain->steps[1].profile.cycles, 2U);
  ASSERT_EQ(plain->parameters.size(), 2U);
  EXPECT_EQ(plain->parameters[0].unit, "kpa");
  EXPECT_EQ(plain->parameters[1].unit, "");
  EXPECT_EQ(plain->parameters[0].about, "how hard");
  EXPECT_EQ(plain->parameters[0].at.line, 3);

  const auto asked = read(std::string(declared) + steps, problems, {{"rounds", 5}, {"level_kpa", 12.5}});
  ASSERT_TRUE(asked) << problems.format();
  EXPECT_EQ(asked->steps[0].target.value, 12.5);
  EXPECT_EQ(asked->steps[1].profile.cycles, 5U);
  const auto prepared = prepare(*asked, two_finger_settings(), problems);
  ASSERT_TRUE(prepared) << problems.format();
  EXPECT_EQ(prepared->parameters, (std::vector<Argument>{{"level_kpa", 12.5}, {"rounds", 5}}));
}

struct Wrong {
  const char* what;
  std::string text;
  std::vector<Argument> arguments;
  std::string message;
};
class WrongParameters : public testing::TestWithParam<Wrong> {};

TEST_P(WrongParameters, AreRefusedWithTheExpectedMessage) {
  document::Problems problems;
  EXPECT_FALSE(read(GetParam().text, problems, GetParam().arguments));
  EXPECT_NE(problems.format().find(GetParam().message), std::string::npos) << problems.format();
}

std::string with(const std::string& parameter, const std::string& step) {
  return "name: x\nparameters:\n  " + parameter + "\nsteps:\n  - " + step + "\n";
}
const std::string level = "level_kpa: {default: 20, range: [10, 40], about: how hard}";
const std::string go = "move: {pressure_kpa: $level_kpa, duration_s: 1}";

INSTANTIATE_TEST_SUITE_P(
    , WrongParameters,
    testing::Values(
        Wrong{"no_such_argument",
              with(level, go),
              {{"levl_kpa", 12}},
              "seq.yaml:2:1: the sequence has no parameter `levl_kpa`"},
        Wrong{"meant", with(level, go), {{"levl_kpa", 12}}, "did you mean `level_kpa`?"},
        Wrong{"without_its_unit", with(level, go), {{"level", 12}}, "did you mean `level_kpa`?"},
        Wrong{"no_parameters_at_all",
              "name: x\nsteps:\n  - move: {pressure_kpa: 5}\n",
              {{"level_kpa", 12}},
              "this sequence has no `parameters`"},
        Wrong{"out_of_range",
              with(level, go),
              {{"level_kpa", 41}},
              "seq.yaml:3:3: `level_kpa` is set to 41, outside its range of 10 to 40"},
        Wrong{"another_unit", with(level, go), {{"level_kpa", 0.2}}, "0.2 bar would be 20"},
        Wrong{"not_a_number",
              with(level, go),
              {{"level_kpa", std::numeric_limits<double>::quiet_NaN()}},
              "is set to"},
        Wrong{"set_twice", with(level, go), {{"level_kpa", 12}, {"level_kpa", 13}}, "is set twice"},
        Wrong{"unknown_name",
              with(level, "move: {pressure_kpa: $levl_kpa, duration_s: $level_kpa}"),
              {},
              "seq.yaml:5:26: there is no parameter `levl_kpa`"},
        Wrong{"computed",
              with(level, "move: {pressure_kpa: $level_kpa + 1}"),
              {},
              "expressions are not supported"},
        Wrong{"unused",
              with(level, "move: {pressure_kpa: 20}"),
              {},
              "seq.yaml:3:3: no step uses the parameter"},
        Wrong{"unit_of_the_key",
              with(level, "move: {pressure_kpa: 20, duration_s: $level_kpa}"),
              {},
              "`duration_s` is `s`, the parameter `level_kpa` is `kpa`"},
        Wrong{"as_a_text",
              with("level: {unit: none, default: 2, range: [1, 3], about: x}",
                   "move: {pressure_kpa: 20, name: $level}"),
              {},
              "must be a text, found `2` (`$level`)"},
        Wrong{"in_a_list",
              with(level, "move: {pressure_kpa: $level_kpa, channels: [$level_kpa]}"),
              {},
              "not an item of a list"},
        Wrong{"no_unit",
              with("level: {default: 20, range: [10, 40], about: x}", "move: {pressure_kpa: $level}"),
              {},
              "the unit of `level` is not stated"},
        Wrong{"foreign_unit",
              with("level_bar: {default: 20, range: [10, 40], about: x}", "move: {pressure_kpa: $level_bar}"),
              {},
              "end the name with its unit (_kpa"},
        Wrong{"two_units",
              with("level_kpa: {unit: mm, default: 20, range: [10, 40], about: x}", go),
              {},
              "ends with a different unit, `kpa`"},
        Wrong{"default_outside",
              with("level_kpa: {default: 50, range: [10, 40], about: x}", go),
              {},
              "`default` is 50, outside its range of 10 to 40"},
        Wrong{"no_range",
              with("level_kpa: {default: 20, range: [40, 10], about: x}", go),
              {},
              "must be below the second number"},
        Wrong{"no_sentence",
              with("level_kpa: {default: 20, range: [10, 40]}", go),
              {},
              "lacks the key `about`"},
        Wrong{"decimal_comma",
              with("level_kpa: {default: 20, range: [10,5, 40], about: x}", go),
              {},
              "the decimal mark is a point: 10.5"},
        Wrong{"a_list",
              "name: x\nparameters: [a]\nsteps:\n  - move: {pressure_kpa: 5}\n",
              {},
              "must be a map of names"},
        Wrong{"no_name",
              with("Level_kpa: {default: 20, range: [10, 40], about: x}", go),
              {},
              "is not a valid name of a parameter"},
        Wrong{"not_whole",
              with("rounds: {unit: none, default: 2, range: [1, 5], about: x}",
                   "pressure: {signal: tp1, cycles: $rounds}"),
              {{"rounds", 2.5}},
              "seq.yaml:3:3: with `rounds` = 2.5, line 5 is wrong: `cycles` must be a whole number, found "
              "`2.5` (`$rounds`)"},
        Wrong{"an_end_that_no_rig_has",
              with("rounds: {unit: none, default: 2, range: [0, 5], about: x}",
                   "pressure: {signal: tp1, cycles: $rounds}"),
              {},
              "seq.yaml:3:3: with `rounds` = 0, the lower end of its range, line 5 is wrong: `cycles` is 0"}),
    [](const auto& test) { return std::string(test.param.what); });

document::Document three_lines() {
  document::Document document;
  document.file = "seq.yaml";
  document.text = "a_s: {}\nb_s: {}\nsteps: []\n";
  return document;
}

std::vector<Parameter> two_parameters() {
  Parameter a{"a_s", "s", 0, 10, 2, "", {1, 1}, 2};
  Parameter b{"b_s", "s", 0, 10, 3, "", {2, 1}, 3};
  return {a, b};
}

document::Problem wrong(const std::string& message) {
  return {"seq.yaml", {3, 1}, "steps: []", message, ""};
}

TEST(Blame, NamesTheParameterThatAloneCausesTheError) {
  const Judge judge = [](const std::vector<Parameter>& values) {
    document::Problems found;
    if (values[1].value > 7) found.add(wrong("the sequence is too long"));
    return found;
  };
  std::vector<Parameter> values = two_parameters();
  values[0].value = 9;
  values[1].value = 8;
  document::Problems problems;
  blame_values(three_lines(), values, judge, problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list()[0].at, (document::Location{2, 1}));
  EXPECT_EQ(problems.list()[0].message, "with `b_s` = 8, line 3 is wrong: the sequence is too long");
}

TEST(Blame, NamesTheStepIfSeveralParametersCauseTheError) {
  const Judge judge = [](const std::vector<Parameter>& values) {
    document::Problems found;
    if (values[0].value + values[1].value > 15) found.add(wrong("the sequence is too long"));
    return found;
  };
  std::vector<Parameter> values = two_parameters();
  document::Problems problems;
  blame_ends(three_lines(), values, judge, problems);
  EXPECT_TRUE(problems.empty()) << "each limit of the range is valid by itself: " << problems.format();
  values[0].value = 9;
  values[1].value = 8;
  blame_values(three_lines(), values, judge, problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list()[0].at, (document::Location{3, 1}));
  EXPECT_EQ(problems.list()[0].message, "with `a_s` = 9, `b_s` = 8: the sequence is too long");
}

TEST(Blame, TriesBothEndsOfEachRange) {
  const Judge judge = [](const std::vector<Parameter>& values) {
    document::Problems found;
    if (values[0].value < 1) found.add(wrong("too short"));
    if (values[1].value > 9) found.add(wrong("the sequence is too long"));
    return found;
  };
  document::Problems problems;
  blame_ends(three_lines(), two_parameters(), judge, problems);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems.list()[0].message,
            "with `a_s` = 0, the lower end of its range, line 3 is wrong: too short");
  EXPECT_EQ(problems.list()[1].message,
            "with `b_s` = 10, the upper end of its range, line 3 is wrong: the sequence is too long");
}

TEST(Blame, AnErrorForAllValuesIsNotBlamedOnAParameter) {
  const Judge judge = [](const std::vector<Parameter>&) {
    document::Problems found;
    found.add(wrong("wrong"));
    return found;
  };
  std::vector<Parameter> values = two_parameters();
  values[0].value = 9;
  document::Problems problems;
  blame_ends(three_lines(), values, judge, problems);
  EXPECT_TRUE(problems.empty());
  blame_values(three_lines(), values, judge, problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list()[0].message, "wrong");
}

}  // namespace
}  // namespace softgrip::control::parameters_test
