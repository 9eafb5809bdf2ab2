#include "tools/commissioning/examinations.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "base/files.h"
#include "base/net/listener.h"

namespace softgrip::tools::doctor::gateway_examination_test {
namespace {

namespace fs = std::filesystem;

class Gateways : public ::testing::Test {
 protected:
  void enable(const std::string& program) {
    fs::create_symlink("/nowhere", folder_ / (program + ".service"));
  }
  /// Copies a configuration file of the project to the test folder. In the copy, replaces the text `was` by
  /// the port `port`.
  void configure(const std::string& name, const std::string& was, std::uint16_t port) {
    std::string text = *read_file(SOFTGRIP_SOURCE_DIR "/config/" + name, 65536);
    const std::size_t at = text.find(was);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, was.size(), "port: " + std::to_string(port));
    ASSERT_TRUE(write_file(folder_ / name, text));
  }
  std::vector<Finding> found() const {
    Findings findings;
    examine_gateways(folder_, folder_, findings);
    return findings.list();
  }

  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
};

TEST_F(Gateways, ADisabledServiceHasNoFinding) {
  configure("web.yaml", "port: 8017", 1);
  EXPECT_TRUE(found().empty());
}

TEST_F(Gateways, AnEnabledServiceThatListensIsOk) {
  const auto plc = net::listen_tcp("127.0.0.1", 0);
  const auto web = net::listen_tcp("127.0.0.1", 0);
  configure("plc.yaml", "port: 502", plc->port);
  configure("web.yaml", "port: 8017", web->port);
  enable("softgrip-plc");
  enable("softgrip-web");
  ASSERT_EQ(found().size(), 2U);
  EXPECT_EQ(found()[0].name, "softgrip-plc");
  EXPECT_EQ(found()[0].verdict, Verdict::ok);
  EXPECT_EQ(found()[1].name, "softgrip-web");
  EXPECT_EQ(found()[1].verdict, Verdict::ok);
}

TEST_F(Gateways, AnEnabledServiceThatDoesNotListenIsAWarning) {
  const std::uint16_t port = net::listen_tcp("127.0.0.1", 0)->port;
  configure("web.yaml", "port: 8017", port);
  enable("softgrip-web");
  ASSERT_EQ(found().size(), 1U);
  EXPECT_EQ(found()[0].verdict, Verdict::warn);
  EXPECT_NE(found()[0].text.find("not listening on 127.0.0.1:" + std::to_string(port)), std::string::npos);
}

TEST_F(Gateways, AnUnusableConfigurationFileIsAWarning) {
  enable("softgrip-plc");
  ASSERT_EQ(found().size(), 1U);
  EXPECT_EQ(found()[0].verdict, Verdict::warn);
  EXPECT_NE(found()[0].text.find("plc.yaml cannot be used"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::tools::doctor::gateway_examination_test
