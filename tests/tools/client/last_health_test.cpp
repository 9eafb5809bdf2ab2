#include "tools/client/daemon_text.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/files.h"

namespace softgrip::tools::last_health_test {
namespace {

using Json = nlohmann::ordered_json;

class LastHealth : public ::testing::Test {
 protected:
  [[nodiscard]] Json read(const std::string& text) const {
    EXPECT_TRUE(write_file((recordings / "health/health.json").string(), text));
    return last_health(recordings.string());
  }
  [[nodiscard]] Json aged(double age_s, const std::string& left) const {
    const double made = static_cast<double>(wall_time_now()) * 1e-9 - age_s;
    Json json{{"made_unix_s", made}};
    json["fingers"] = Json::array({{{"finger", "left"},
                                    {"state", left},
                                    {"sentence", "The finger left has changed since 2026-08-09."},
                                    {"suspects", {{{"id", "leak"}, {"next_steps", {"Listen.", "Close."}}}}}},
                                   {{"finger", "right"}, {"state", "steady"}}});
    return read(json.dump());
  }

  const ScratchFolder scratch;
  std::filesystem::path recordings = scratch.path();
};

TEST_F(LastHealth, ReportsTheChangedFingerAndTheFirstNextStep) {
  const auto lines = health_lines(aged(7200, "alarm"));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].text, "The finger left has changed since 2026-08-09.");
  EXPECT_EQ(lines[0].advice, "Listen.");
  EXPECT_FALSE(lines[0].good);
}

TEST_F(LastHealth, ReportsNoChangeWithTheAgeOfTheCheck) {
  const auto lines = health_lines(aged(7200, "steady"));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].good);
  EXPECT_EQ(lines[0].text, "no change detected at 2 fingers, checked 2 h ago");
}

TEST_F(LastHealth, ReportsTheWarningsThatConcernTheWholeRig) {
  Json json = aged(7200, "steady");
  json["warnings"] = Json::array({"All fingers of the rig show the same change.", 3});
  const auto lines = health_lines(json);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].text, "All fingers of the rig show the same change.");
  EXPECT_FALSE(lines[0].good);
  EXPECT_TRUE(lines[1].good);
}

TEST_F(LastHealth, WarnsIfTheLastCheckIsTenDaysOld) {
  const auto lines = health_lines(aged(10 * 86400, "steady"));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_FALSE(lines[1].good);
  EXPECT_EQ(lines[1].text, "the fingers were last checked 10 days ago");
}

TEST_F(LastHealth, IsNullForAMissingOrMalformedResult) {
  EXPECT_TRUE(last_health("").is_null());
  EXPECT_TRUE(last_health(recordings.string()).is_null());
  for (const char* text :
       {"", "{", "[]", "{}", R"({"made_unix_s": "x", "fingers": []})", R"({"made_unix_s": 1, "fingers": 2})"})
    EXPECT_TRUE(read(text).is_null()) << text;
  EXPECT_TRUE(health_lines(nullptr).empty());
}

/// last_health() must refuse a named pipe. If it waited for a program that writes to the pipe, this test
/// would never end.
TEST_F(LastHealth, IsNullIfThePathIsANamedPipe) {
  std::filesystem::create_directories(recordings / "health");
  ASSERT_EQ(::mkfifo((recordings / "health/health.json").c_str(), 0600), 0);
  EXPECT_TRUE(last_health(recordings.string()).is_null());
}

}  // namespace
}  // namespace softgrip::tools::last_health_test
