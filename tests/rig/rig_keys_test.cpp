// Tests the tables in which the keys of rig files are declared. Each key of a rig file that softgrip writes
// or ships must be in a table of its map, or in the list other_keys. No table may contain a key twice.

#include "rig/rig_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "document/node.h"
#include "tests/support/files.h"
#include "tools/commissioning/rig_template.h"

namespace softgrip::rig::rig_keys_test {
namespace {

using document::Node;
using Names = std::vector<std::string>;

/// The tables of rig_tables() that list the keys of a map, by the key whose value is this map.
const std::map<std::string, Names> tables_of_maps{
    {"rig", {"rig"}},
    {"modbus_tcp", {"modbus_tcp", "timing"}},
    {"modbus_rtu", {"modbus_rtu", "timing"}},
    {"modules", {"modbus_tcp"}},
    {"iio", {"iio", "timing"}},
    {"inputs", {"terminal"}},
    {"outputs", {"terminal"}},
    {"heartbeat", {"heartbeat"}},
    {"simulated", {"simulated"}},
    {"plants", {}},
    {"a plant", {"plant"}},
    {"channel_defaults", {"channel"}},
    {"channels", {"channel"}},
    {"pid", {"pid"}},
    {"limits", {"limits"}},
    {"valve", {"valve"}},
    {"sensor", {"sensor"}},
    {"pressure_monitor", {"sensor"}},
    {"safety", {"safety"}},
    {"faults", {"faults"}},
    {"plausibility", {"plausibility"}},
    {"detection", {"detection"}},
    {"rest", {"rest"}},
    {"model_health", {"model_health"}},
    {"loop", {"loop"}},
    {"real_time", {"real_time"}},
    {"recorder", {"recorder"}},
    {"socket", {"socket"}},
};
/// The keys that have no declaration. The pages describe them in sentences.
const std::map<std::string, Names> other_keys{
    {"board", {"modbus_tcp", "modbus_rtu", "iio", "simulated"}},
    {"modules", {"name"}},
    {"plants", {"left", "right"}},
    {"object", {"position_mm", "yielding"}},
    {"pressure_monitor", {"is_kpa"}},
    {"safe_action", {"idle", "closing", "holding", "releasing"}},
    {"read_only", {"path", "mode"}},
};

std::set<std::string> permitted_in(const std::string& map) {
  std::set<std::string> names;
  if (const auto others = other_keys.find(map); others != other_keys.end())
    names.insert(others->second.begin(), others->second.end());
  const auto its = tables_of_maps.find(map);
  for (const auto& [table, keys] : rig_tables()) {
    if (its == tables_of_maps.end() || std::ranges::find(its->second, table) == its->second.end()) continue;
    for (const document::KeyFacts& key : keys) names.insert(key.name);
  }
  return names;
}

struct Found {
  std::size_t keys = 0;
  Names undeclared;  ///< "map: key" for each key that is in no table of its map
};

void look_up(const Node& node, const std::string& map, Found& found) {
  for (const Node& item : node.items) look_up(item, map, found);
  const std::set<std::string> permitted = node.entries.empty() ? std::set<std::string>{} : permitted_in(map);
  for (const Node::Entry& entry : node.entries) {
    ++found.keys;
    if (!permitted.contains(entry.key)) found.undeclared.push_back(map + ": " + entry.key);
    look_up(entry.value, map == "plants" ? "a plant" : entry.key, found);
  }
}

Found keys_in(const std::string& text) {
  document::Problems problems;
  const document::Document document = document::parse("rig.yaml", text, problems);
  EXPECT_TRUE(problems.empty()) << problems.format();
  Found found;
  look_up(document.root, "rig", found);
  return found;
}

/// Returns the template without its marks. A mark at the start of a line stands for whole lines and is
/// removed. Any other mark stands for a value and is replaced by 0.
std::string without_marks(std::string text) {
  for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$', at)) {
    const bool lines = at == 0 || text[at - 1] == '\n';
    text.replace(at, text.find('$', at + 1) + 1 - at, lines ? "" : "0");
  }
  return text;
}

TEST(RigKeys, ContainEveryKeyOfTheTemplateOfInit) {
  const Found found = keys_in(without_marks(std::string(tools::rig_template)));
  EXPECT_GE(found.keys, 60U);
  EXPECT_EQ(found.undeclared, Names{});
}

TEST(RigKeys, ContainEveryKeyOfTheRigFilesInConfig) {
  std::size_t files = 0;
  for (const char* const name : {"rig", "rig_planned", "rig_tcp", "rig_rtu", "rig_iio", "rig_service"}) {
    const Found found =
        keys_in(test::text_of(std::string(SOFTGRIP_SOURCE_DIR) + "/config/" + name + ".yaml"));
    EXPECT_GE(found.keys, 60U) << name;
    EXPECT_EQ(found.undeclared, Names{}) << name;
    ++files;
  }
  EXPECT_EQ(files, 6U);
}

TEST(RigKeys, AreLookedUpInTheTableOfTheirMap) {
  EXPECT_EQ(keys_in("rate_hz: 1\npid: {rate_hz: 1}\nchannels:\n  - {name: a, limits: {kp: 1}}\n").undeclared,
            (Names{"rig: pid", "pid: rate_hz", "limits: kp"}));
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
