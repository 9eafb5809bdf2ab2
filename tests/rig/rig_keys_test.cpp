// Tests that the declarations contain every key of the rig files that softgrip writes and ships, and that
// each table has each key once.

#include "rig/rig_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "tools/commissioning/rig_template.h"

namespace softgrip::rig::rig_keys_test {
namespace {

std::set<std::string> declared() {
  std::set<std::string> names;
  for (const auto& [table, keys] : rig_tables()) {
    for (const document::KeyFacts& key : keys) names.insert(key.name);
  }
  return names;
}

/// Returns the words before a colon in a YAML text without its comments.
std::set<std::string> keys_in(const std::string& text) {
  std::set<std::string> keys;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    for (std::size_t colon = line.find(':'); colon != std::string::npos; colon = line.find(':', colon + 1)) {
      std::size_t begin = colon;
      while (begin > 0 &&
             (std::islower(static_cast<unsigned char>(line[begin - 1])) != 0 || line[begin - 1] == '_'))
        --begin;
      if (begin < colon) keys.insert(line.substr(begin, colon - begin));
    }
  }
  return keys;
}

std::vector<std::string> undeclared_keys(const std::string& text, const std::set<std::string>& others) {
  const std::set<std::string> known = declared();
  std::vector<std::string> unknown;
  for (const std::string& key : keys_in(text)) {
    if (!known.contains(key) && !others.contains(key)) unknown.push_back(key);
  }
  return unknown;
}

/// The phases of `safe_action`.
const std::set<std::string> phases{"idle", "closing", "holding", "releasing"};

TEST(RigKeys, ContainEveryKeyOfTheTemplateOfInit) {
  const std::string text(tools::rig_template);
  EXPECT_GE(keys_in(text).size(), 60U);
  EXPECT_EQ(undeclared_keys(text, phases), std::vector<std::string>{});
}

TEST(RigKeys, ContainEveryKeyOfTheRigFilesInConfig) {
  std::set<std::string> others = phases;
  // Kinds of boards, names of channels, and the keys of an object, which the emulator reads, too.
  others.insert({"modbus_tcp", "modbus_rtu", "iio", "simulated", "left", "right", "position_mm", "yielding"});
  std::size_t files = 0;
  for (const char* const name : {"rig", "rig_planned", "rig_tcp", "rig_rtu", "rig_iio", "rig_service"}) {
    std::ostringstream text;
    text << std::ifstream(std::string(SOFTGRIP_SOURCE_DIR) + "/config/" + name + ".yaml").rdbuf();
    EXPECT_GE(keys_in(text.str()).size(), 60U) << name;
    EXPECT_EQ(undeclared_keys(text.str(), others), std::vector<std::string>{}) << name;
    ++files;
  }
  EXPECT_EQ(files, 6U);
}

TEST(RigKeys, AreUniqueInEachTable) {
  EXPECT_GE(rig_tables().size(), 20U);
  for (const auto& [table, keys] : rig_tables()) {
    std::set<std::string> names;
    for (const document::KeyFacts& key : keys) {
      EXPECT_TRUE(names.insert(key.name).second) << table << ": " << key.name;
      EXPECT_FALSE(key.meaning.empty()) << table << ": " << key.name;
    }
  }
}

}  // namespace
}  // namespace softgrip::rig::rig_keys_test
