// Tests configurations that contain errors. The name of each file broken/NAME.yaml describes the error in the
// file. NAME.expected contains all messages that the check of this file must print. If a file NAME.also
// exists, it lists other files that are checked together with NAME.yaml.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "rig/check.h"
#include "tests/support/files.h"

namespace softgrip::daemon::broken_test {
namespace {

const std::filesystem::path folder = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "tests/config";

using test::text_of;

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "broken")) {
    if (entry.path().extension() == ".yaml") result.push_back(entry.path().stem().string());
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Runs the check in the working directory tests/config, so that the messages contain short paths.
rig::CheckReport check(const std::string& name) {
  std::filesystem::current_path(folder);
  std::vector<std::string> paths{"broken/" + name + ".yaml"};
  std::istringstream also(text_of("broken/" + name + ".also"));
  for (std::string path; std::getline(also, path);) paths.push_back(path);
  return rig::check_files(paths);
}

class Broken : public ::testing::TestWithParam<std::string> {};

TEST_P(Broken, ReportsExactlyTheExpectedProblems) {
  const rig::CheckReport report = check(GetParam());
  EXPECT_FALSE(report.accepted());
  EXPECT_EQ(report.problems.format(), text_of("broken/" + GetParam() + ".expected"));
}

INSTANTIATE_TEST_SUITE_P(Configurations, Broken, ::testing::ValuesIn(names()),
                         [](const auto& parameter) { return parameter.param; });

TEST(BrokenConfigurations, IncludeAtLeast10FilesWithThreeOrMoreProblems) {
  std::size_t several = 0;
  for (const std::string& name : names()) several += check(name).problems.size() >= 3 ? 1U : 0U;
  EXPECT_GE(names().size(), 20U);
  EXPECT_GE(several, 10U);
}

}  // namespace
}  // namespace softgrip::daemon::broken_test
