#include "rig/plc_file/settings.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/files.h"
#include "tests/support/files.h"

namespace softgrip::plc::settings_test {
namespace {

std::string shipped() {
  return test::text_of(SOFTGRIP_SOURCE_DIR "/config/plc.yaml");
}

/// Replaces the text `was` of the shipped file config/plc.yaml by `is`. Returns the problems of the changed
/// file.
std::string said_of(const std::string& was, const std::string& is) {
  std::string text = shipped();
  const std::size_t at = text.find(was);
  EXPECT_NE(at, std::string::npos) << was;
  text.replace(at, was.size(), is);
  const ScratchFolder folder;
  const std::string path = folder.path() + "/plc.yaml";
  std::ofstream(path) << text;
  document::Problems problems;
  const auto settings = load_settings(path, problems);
  EXPECT_EQ(settings.has_value(), problems.empty());
  return problems.format();
}

TEST(PlcSettings, TheShippedFileIsRead) {
  document::Problems problems;
  const auto settings = load_settings(SOFTGRIP_SOURCE_DIR "/config/plc.yaml", problems);
  ASSERT_TRUE(settings) << problems.format();
  EXPECT_EQ(settings->address, "127.0.0.1");
  EXPECT_EQ(settings->allow, std::vector<std::string>{"127.0.0.1"});
  EXPECT_EQ(settings->when_silent, Reaction::stop);
  ASSERT_GE(settings->recipes.size(), 2U);
  EXPECT_EQ(settings->recipes[0].squeeze, "squeeze_kpa");
  EXPECT_EQ(settings->registers.at(Name::done_counter), 101);
  EXPECT_EQ(settings->registers.at(Name::finger_displacement, 1), 131);
  EXPECT_DOUBLE_EQ(settings->registers.of_one(Name::squeeze), 0.01);
}

TEST(PlcSettings, InvalidSettingsAreReportedWithTheReason) {
  EXPECT_NE(said_of("address: 101", "address: 100").find("belongs to both 'map_version' and 'done_counter'"),
            std::string::npos);
  EXPECT_NE(said_of("first: 120", "first: 100").find("address 100"), std::string::npos);
  EXPECT_NE(said_of("name: recipe", "name: receipt").find("recipe"), std::string::npos);
  EXPECT_NE(said_of("name: heartbeat", "name: fingers").find("appears twice"), std::string::npos);
  EXPECT_NE(said_of("unit: 0.01 kPa", "unit: 0.01 bar")
                .find("not a resolution (the physical value that corresponds to 1 in the register)"),
            std::string::npos);
  EXPECT_NE(said_of("squeeze: squeeze_kpa", "squeeze: squeeze_mm").find("must end with `_kpa`"),
            std::string::npos);
  EXPECT_NE(said_of("number: 2", "number: 1").find("another recipe already has the number 1"),
            std::string::npos);
  EXPECT_NE(said_of("address: 127.0.0.1 ", "address: localhost ").find("not a numeric address"),
            std::string::npos);
  EXPECT_NE(said_of("when_silent: stop", "when_silent: hope").find("vent"), std::string::npos);
  EXPECT_NE(said_of("silence_s", "silence_ms").find("silence_s"), std::string::npos);
}

TEST(PlcSettings, AResolutionMustBeFinite) {
  EXPECT_NE(said_of("unit: 0.01 kPa", "unit: inf kPa").find("not a resolution"), std::string::npos);
}

TEST(PlcSettings, EachNotationOfAPermittedAddressIsAccepted) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/plc.yaml";
  std::string text = shipped();
  const std::string was = "allow: [127.0.0.1]";
  text.replace(text.find(was), was.size(),
               "allow: [\"FE80:0:0:0:0:0:0:1\", \"::ffff:10.0.0.5\", 10.0.0.5, \"fe80::1\"]");
  std::ofstream(path) << text;
  document::Problems problems;
  const auto settings = load_settings(path, problems);
  ASSERT_TRUE(settings) << problems.format();
  EXPECT_EQ(settings->allow, (std::vector<std::string>{"fe80::1", "10.0.0.5"}));
}

TEST(PlcSettings, EveryPermittedAddressMustFindAConnection) {
  const std::string five = "allow: [10.0.0.1, 10.0.0.2, 10.0.0.3, 10.0.0.4, 10.0.0.5]";
  EXPECT_NE(said_of("allow: [127.0.0.1]", five).find("5 addresses may connect, but `max_masters` is 4"),
            std::string::npos);
  EXPECT_EQ(said_of("allow: [127.0.0.1]", "allow: [10.0.0.1, 10.0.0.2, 10.0.0.3, 10.0.0.4]"), "");
}

TEST(PlcSettings, ANetworkAddressRequiresAListOfClients) {
  const std::string said = said_of(
      "address: 127.0.0.1            # loopback; for a PLC the address of this computer in "
      "the machine's network\n  port: 502\n  allow: [127.0.0.1]",
      "address: 192.168.1.5\n  port: 502\n  allow: []");
  EXPECT_NE(said.find("the permitted clients must be listed"), std::string::npos) << said;
}

}  // namespace
}  // namespace softgrip::plc::settings_test
