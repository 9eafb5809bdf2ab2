#include "tools/importing/import_run.h"

#include <gtest/gtest.h>

namespace softgrip::tools::import_run_test {
namespace {

using sysid::Role;

TEST(ImportOptions, OptionsOverrideTheExistingMapping) {
  sysid::Mapping begun;
  begun[Role::command].columns = {"p"};
  begun[Role::command].unit = "bar";
  begun[Role::displacement].columns = {"x"};
  ImportOptions options;
  options.columns[static_cast<std::size_t>(Role::displacement)] = {"y", "z"};
  options.units = {"command=psi"};
  options.scales = {"displacement=-2.5"};
  options.zeros = {"displacement=first", "command=14.7"};
  options.missing = {"LOST"};
  options.separator = "tab";
  const auto mapping = mapping_of(options, begun);
  ASSERT_TRUE(mapping) << mapping.error();
  EXPECT_EQ((*mapping)[Role::command].columns, std::vector<std::string>{"p"});
  EXPECT_EQ((*mapping)[Role::command].unit, "psi");
  EXPECT_EQ((*mapping)[Role::command].zero, 14.7);
  EXPECT_EQ((*mapping)[Role::displacement].columns, (std::vector<std::string>{"y", "z"}));
  EXPECT_EQ((*mapping)[Role::displacement].scale, -2.5);
  EXPECT_TRUE((*mapping)[Role::displacement].zero_first);
  EXPECT_EQ(mapping->separator, '\t');
  EXPECT_EQ(mapping->missing, std::vector<std::string>{"lost"});
}

TEST(ImportOptions, AnotherColumnHasNoSettingsOfTheExistingMapping) {
  sysid::Mapping begun;
  begun[Role::command] = {{"p"}, "psi", {}, 14.7, false};
  begun[Role::displacement] = {{"x"}, "", -2.5, {}, true};
  ImportOptions options;
  options.columns[static_cast<std::size_t>(Role::command)] = {"p2_kpa"};
  options.columns[static_cast<std::size_t>(Role::displacement)] = {"x"};
  const auto mapping = mapping_of(options, begun);
  ASSERT_TRUE(mapping) << mapping.error();
  EXPECT_EQ((*mapping)[Role::command], (sysid::ColumnMapping{{"p2_kpa"}, {}, {}, {}, false}));
  EXPECT_EQ((*mapping)[Role::displacement], begun[Role::displacement]) << "the column is the same";
}

TEST(ImportOptions, ARateReplacesTheTimeOfTheExistingMapping) {
  sysid::Mapping begun;
  begun[Role::time] = {{"t"}, "ms", {}, {}, false};
  ImportOptions options;
  options.rate_hz = 50;
  auto mapping = mapping_of(options, begun);
  ASSERT_TRUE(mapping) << mapping.error();
  EXPECT_EQ(mapping->rate_hz, 50);
  EXPECT_EQ((*mapping)[Role::time], sysid::ColumnMapping{});
  options.rate_hz.reset();
  options.columns[static_cast<std::size_t>(Role::time)] = {"t"};
  mapping = mapping_of(options, *mapping);
  ASSERT_TRUE(mapping) << mapping.error();
  EXPECT_FALSE(mapping->rate_hz);
  EXPECT_EQ((*mapping)[Role::time].columns, std::vector<std::string>{"t"});
  options.rate_hz = 50;
  EXPECT_FALSE(mapping_of(options, {})) << "both options are given";
}

TEST(ImportOptions, CodesOfOneColumnEndWithANumber) {
  sysid::Mapping begun;
  begun.missing_in = {{"p", 999}};
  ImportOptions options;
  options.missing_in = {"a=b=-0.5"};
  const auto stated = mapping_of(options, begun);
  ASSERT_TRUE(stated) << stated.error();
  EXPECT_EQ(stated->missing_in, (std::vector<sysid::ColumnCode>{{"a=b", -0.5}}));
  options.missing_in = {};
  options.missing = {"na"};
  const auto kept = mapping_of(options, begun);
  ASSERT_TRUE(kept) << kept.error();
  EXPECT_TRUE(kept->missing_in.empty()) << "--missing overrides the codes that an earlier import found";
  for (const char* word : {"tip_mm", "tip_mm=lost", "=999", "tip_mm=inf"}) {
    options.missing_in = {word};
    const auto wrong = mapping_of(options, {});
    ASSERT_FALSE(wrong) << word;
    EXPECT_NE(wrong.error().find("COLUMN=NUMBER is expected"), std::string::npos) << wrong.error();
  }
}

TEST(ImportOptions, AnErrorDistinguishesRoleAndValue) {
  const auto error_of = [](const ImportOptions& options) {
    const auto mapping = mapping_of(options, {});
    return mapping ? std::string("no error") : mapping.error();
  };
  ImportOptions options;
  for (const char* word : {"displacement=abc", "displacement=0", "displacement=nan"}) {
    options.scales = {word};
    EXPECT_EQ(error_of(options),
              std::string("--scale ") + word + ": the value of displacement must be a number other than 0");
  }
  options.scales = {"displacment=2"};
  EXPECT_NE(error_of(options).find("ROLE=VALUE is expected; roles are time"), std::string::npos);
  options = {};
  options.zeros = {"displacement=frist"};
  EXPECT_EQ(error_of(options),
            "--zero displacement=frist: the value of displacement must be a number or the word first");
}

TEST(ImportOptions, TheStartIsBeforeTheEnd) {
  ImportOptions options;
  options.from_s = 20, options.to_s = 10;
  const auto mapping = mapping_of(options, {});
  ASSERT_FALSE(mapping);
  EXPECT_EQ(mapping.error(),
            "the start (from-s, 20 s) is after the end (to-s, 10 s); the start must be before the end");
}

TEST(ImportOptions, AFurtherValueOfAnOptionIsNoFile) {
  ImportOptions options;
  options.files = {"displacement=3", "day.csv"};
  options.scales = {"command=2"};
  const auto checked = check_files(options);
  ASSERT_FALSE(checked);
  EXPECT_EQ(
      checked.error(),
      "'displacement=3' is not a file. An option such as --scale has one value, so repeat the option for "
      "each further value: --scale displacement=3");
  options.files = {"day=3.csv"};
  EXPECT_TRUE(check_files(options));
}

TEST(ImportTargets, AMissingFileMayBeAValueOfAnOption) {
  const auto targets = import_targets({"absent_column", "/dev/null"}, "log.csv");
  ASSERT_FALSE(targets);
  EXPECT_EQ(targets.error(),
            "there is no file 'absent_column'. If 'absent_column' is a further value of an option such as "
            "--command, repeat the option for this value");
}

TEST(ImportTargets, OneInputBecomesAFileAndSeveralBecomeAFolder) {
  EXPECT_EQ(*import_targets({"a/day.csv"}, "log.csv"), std::vector<std::string>{"log.csv"});
  EXPECT_EQ(*import_targets({"a/day.csv.gz", "b/run.mat"}, "logs/"),
            (std::vector<std::string>{"logs/day.csv", "logs/run.csv"}));
  EXPECT_FALSE(import_targets({"a.csv", "b.csv"}, "log.csv"));
  EXPECT_FALSE(import_targets({"a/day.csv", "b/day.mat"}, "logs/"));
}

}  // namespace
}  // namespace softgrip::tools::import_run_test
