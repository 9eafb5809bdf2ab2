#include "control/sequences/blame.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace softgrip::control::blame_test {
namespace {

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

TEST(Blame, FallsOnTheParameterWhoseValueAloneIsEnough) {
  const Judge judge = [](const std::vector<Parameter>& values) {
    document::Problems found;
    if (values[1].value > 7) found.add(wrong("too long"));
    return found;
  };
  std::vector<Parameter> values = two_parameters();
  values[0].value = 9;
  values[1].value = 8;
  document::Problems problems;
  blame_values(three_lines(), values, judge, problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.list()[0].at, (document::Location{2, 1}));
  EXPECT_EQ(problems.list()[0].message, "with `b_s` = 8 line 3 is wrong: too long");
}

TEST(Blame, StaysAtTheStepWhereItTakesSeveral) {
  const Judge judge = [](const std::vector<Parameter>& values) {
    document::Problems found;
    if (values[0].value + values[1].value > 15) found.add(wrong("too long"));
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
  EXPECT_EQ(problems.list()[0].message, "with `a_s` = 9, `b_s` = 8: too long");
}

TEST(Blame, TriesBothEndsOfEachRange) {
  const Judge judge = [](const std::vector<Parameter>& values) {
    document::Problems found;
    if (values[0].value < 1) found.add(wrong("too short"));
    if (values[1].value > 9) found.add(wrong("too long"));
    return found;
  };
  document::Problems problems;
  blame_ends(three_lines(), two_parameters(), judge, problems);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems.list()[0].message,
            "with `a_s` = 0, the lower end of its range, line 3 is wrong: too short");
  EXPECT_EQ(problems.list()[1].message,
            "with `b_s` = 10, the upper end of its range, line 3 is wrong: too long");
}

TEST(Blame, WhatIsWrongAnywayIsNoParametersFault) {
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
}  // namespace softgrip::control::blame_test
