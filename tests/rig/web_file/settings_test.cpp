#include "rig/web_file/settings.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "document/node.h"

namespace softgrip::web::settings_test {
namespace {

/// Replaces the text `was` of the shipped file config/web.yaml by `is`. Returns the problems of the changed
/// file.
std::string said_of(const std::string& was, const std::string& is) {
  std::string text = *read_file(SOFTGRIP_SOURCE_DIR "/config/web.yaml", 65536);
  const std::size_t at = text.find(was);
  EXPECT_NE(at, std::string::npos) << was;
  text.replace(at, was.size(), is);
  document::Problems problems;
  const document::Document document = document::parse("web.yaml", text, problems);
  static_cast<void>(read_settings(document, problems));
  return problems.format();
}

TEST(WebSettings, TheShippedFileGivesReadOnlyAccessWithoutAToken) {
  document::Problems problems;
  const auto settings = load_settings(SOFTGRIP_SOURCE_DIR "/config/web.yaml", problems);
  ASSERT_TRUE(settings) << problems.format();
  EXPECT_EQ(settings->address, "127.0.0.1");
  EXPECT_EQ(settings->port, 8017);
  EXPECT_EQ(settings->without_token, Role::look);
  EXPECT_EQ(settings->tokens, "");
  EXPECT_EQ(settings->recordings, "/var/lib/softgrip/runs");
}

TEST(WebSettings, ANetworkAddressRequiresTokens) {
  const std::string said = said_of("address: 127.0.0.1", "address: 0.0.0.0");
  EXPECT_NE(said.find("each client needs a token"), std::string::npos) << said;
  EXPECT_NE(said.find("`tokens` must name a file"), std::string::npos) << said;
  EXPECT_EQ(said_of("address: 127.0.0.1", "address: \"::1\""), "");
}

TEST(WebSettings, InvalidSettingsAreReportedWithTheReason) {
  EXPECT_NE(said_of("address: 127.0.0.1", "address: gripper").find("not a numeric address"),
            std::string::npos);
  EXPECT_NE(said_of("hosts: []", "hosts: ['http://gripper']").find("not the name of a computer"),
            std::string::npos);
  EXPECT_NE(said_of("port: 8017", "port: 70000").find("port"), std::string::npos);
  EXPECT_NE(said_of("without_token: look", "without_token: all").find("operate"), std::string::npos);
  EXPECT_NE(said_of("session_idle_s", "session_idle").find("session_idle_s"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::web::settings_test
