// Tests `softgrip check` as a user runs it. The command must refuse every broken configuration with exit code
// 3. Its output must contain every line of broken/NAME.expected.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "base/files.h"
#include "tests/support/files.h"

namespace softgrip::tools::check_test {
namespace {

const std::filesystem::path folder = std::filesystem::path(SOFTGRIP_SOURCE_DIR) / "tests/config";

using test::text_of;

struct Outcome {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

/// Returns the path of a folder for the files of this process. The folder is removed when the process ends.
const std::filesystem::path& scratch() {
  static const ScratchFolder folder_of_process;
  static const std::filesystem::path path = folder_of_process.path();
  return path;
}

/// Runs `softgrip check ARGUMENTS` in the folder tests/config.
Outcome check(const std::string& arguments) {
  const std::string out = (scratch() / "out").string();
  const std::string err = (scratch() / "err").string();
  const std::string command = "cd '" + folder.string() + "' && '" SOFTGRIP_PROGRAM "' check " + arguments +
                              " >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "broken")) {
    if (entry.path().extension() == ".yaml") result.push_back(entry.path().stem().string());
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Returns the arguments of `softgrip check` for a file: the path of the file, and the paths of all files
/// that must be checked together with it.
std::string arguments_of(const std::string& name) {
  std::string arguments = "broken/" + name + ".yaml";
  std::istringstream also(text_of(folder / "broken" / (name + ".also")));
  for (std::string path; std::getline(also, path);) arguments += " " + path;
  return arguments;
}

TEST(Check, RefusesEveryBrokenConfigurationWithAllOfItsErrors) {
  EXPECT_GE(names().size(), 20U);
  for (const std::string& name : names()) {
    const Outcome outcome = check(arguments_of(name));
    EXPECT_EQ(outcome.exit_code, 3) << name;
    EXPECT_EQ(outcome.errors, text_of(folder / "broken" / (name + ".expected"))) << name;
  }
}

TEST(Check, JsonReportsProblemsAtTheSamePositions) {
  for (const std::string& name : names()) {
    const Outcome outcome = check("--json " + arguments_of(name));
    EXPECT_EQ(outcome.exit_code, 3) << name;
    const auto json = nlohmann::json::parse(outcome.output, nullptr, false);
    ASSERT_TRUE(json.is_object()) << name << "\n" << outcome.output;
    EXPECT_FALSE(json["accepted"].get<bool>()) << name;
    const std::string expected = text_of(folder / "broken" / (name + ".expected"));
    for (const auto& problem : json["problems"]) {
      const std::string place = problem["file"].get<std::string>() + ":" +
                                std::to_string(problem["line"].get<int>()) + ":" +
                                std::to_string(problem["column"].get<int>()) + ": ";
      EXPECT_NE(expected.find(place), std::string::npos) << name << " " << place;
    }
  }
}

TEST(Check, AcceptsEveryShippedConfiguration) {
  const Outcome outcome = check(
      "../../config/rig.yaml ../../config/rig_tcp.yaml ../../config/boards/*.yaml "
      "../../config/models/*.yaml ../../config/sequences/*.yaml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
}

TEST(Check, RefusesAFileThatIsTooLarge) {
  const std::filesystem::path path = scratch() / "large.yaml";
  std::ofstream(path) << "name: large\n# " << std::string(300'000, 'x') << "\n";
  const Outcome outcome = check("'" + path.string() + "'");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.errors.find("the file is larger than 262144 bytes"), std::string::npos) << outcome.errors;
}

TEST(Check, AMissingFileIsReportedAsAnIoError) {
  const Outcome outcome = check("absent.yaml");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.errors.find("absent.yaml:1:1: the file cannot be read"), std::string::npos);
}

TEST(Check, MissingFileArgumentIsAUsageError) {
  EXPECT_EQ(check("").exit_code, 2);
}

}  // namespace
}  // namespace softgrip::tools::check_test
