#include "rig/plc_file/register_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace softgrip::plc {

namespace {

using document::MapReader;
using document::Node;

constexpr std::array<RegisterInfo, name_count> table{{
    {Name::command_counter, Block::command, "command_counter", ""},
    {Name::command, Block::command, "command", ""},
    {Name::recipe, Block::command, "recipe", ""},
    {Name::squeeze, Block::command, "squeeze", "kPa"},
    {Name::speed, Block::command, "speed", "mm/s"},
    {Name::displacement, Block::command, "displacement", "mm"},
    {Name::master_heartbeat, Block::command, "master_heartbeat", ""},
    {Name::map_version, Block::status, "map_version", ""},
    {Name::done_counter, Block::status, "done_counter", ""},
    {Name::outcome, Block::status, "outcome", ""},
    {Name::reason, Block::status, "reason", ""},
    {Name::state, Block::status, "state", ""},
    {Name::result, Block::status, "result", ""},
    {Name::fault, Block::status, "fault", ""},
    {Name::step, Block::status, "step", ""},
    {Name::fingers, Block::status, "fingers", ""},
    {Name::heartbeat, Block::status, "heartbeat", ""},
    {Name::master, Block::status, "master", ""},
    {Name::finger_result, Block::finger, "result", ""},
    {Name::finger_displacement, Block::finger, "displacement", "mm"},
    {Name::finger_pressure, Block::finger, "pressure", "kPa"},
    {Name::finger_command, Block::finger, "command", "kPa"},
    {Name::finger_squeeze, Block::finger, "squeeze", "kPa"},
    {Name::finger_valid, Block::finger, "valid", ""},
}};

constexpr std::int64_t last_address = 0xffff;
constexpr std::int64_t most_fingers = 16;

/// Returns the number of a resolution text: 0.01 for the text "0.01 kPa" if `unit` is "kPa". Returns 0 if the
/// text has another form or another unit.
double resolution_of(const std::string& text, std::string_view unit) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view rest(read.ptr, static_cast<std::size_t>(text.data() + text.size() - read.ptr));
  return read.ec == std::errc{} && rest == fmt::format(" {}", unit) && value > 0 && std::isfinite(value)
             ? value
             : 0;
}

class Reader {
 public:
  Reader(const document::Document& document, document::Problems& problems, RegisterMap& map)
      : document_(document), problems_(problems), map_(map) {}

  void block(MapReader& reader, Block block, const char* key) {
    std::vector<std::string> missing;
    for (const RegisterInfo& info : table) {
      if (info.block == block) missing.emplace_back(info.key);
    }
    const std::vector<std::string> known = missing;
    for (const Node* const item : reader.sequence(key, true)) entry(*item, block, known, missing);
    if (!missing.empty() && reader.has(key)) {
      reader.report(key, fmt::format("`{}` must list the register '{}', but does not", key, missing.front()),
                    "every register requires an address, even if the PLC does not use the register");
    }
  }

  /// Reports an address that is above the largest possible address, or that is used twice.
  void claim(document::Location at, std::int64_t address, std::string_view what) {
    const auto [taken, is_free] = claimed_.emplace(address, what);
    if (is_free && address <= last_address) return;
    problems_.add(document_.problem(
        at, is_free ? fmt::format("the address of '{}' is above {}, the largest possible address", what,
                                  last_address)
                    : fmt::format("address {} belongs to both '{}' and '{}'", address, taken->second, what)));
  }

 private:
  void entry(const Node& node, Block block, const std::vector<std::string>& known,
             std::vector<std::string>& missing) {
    MapReader reader(document_, node, problems_, "a register");
    const std::string& name = known[reader.choice("name", known)];
    const std::int64_t address = reader.integer("address", {0, last_address});
    static_cast<void>(reader.text("about"));
    if (std::erase(missing, name) == 0 && reader.good("name"))
      reader.report("name", fmt::format("'{}' appears twice", name));
    const auto info = std::find_if(table.begin(), table.end(), [&](const RegisterInfo& other) {
      return other.block == block && other.key == name;
    });
    const auto index = static_cast<std::size_t>(info - table.begin());
    map_.address[index] = static_cast<std::uint16_t>(address);
    if (!info->unit.empty()) {
      map_.resolution[index] = resolution_of(reader.text("unit"), info->unit);
      if (reader.good("unit") && map_.resolution[index] == 0) {
        reader.report(
            "unit",
            "this value is not a resolution (the physical value that corresponds to 1 in the register)",
            fmt::format("write a number and the unit: \"0.01 {}\"", info->unit));
      }
    }
    if (block != Block::finger) claim(node.at, address, name);
  }

  const document::Document& document_;
  document::Problems& problems_;
  RegisterMap& map_;
  std::map<std::int64_t, std::string> claimed_;
};

}  // namespace

const std::array<RegisterInfo, name_count>& registers() noexcept {
  return table;
}

RegisterMap read_register_map(const document::Document& document, const document::Node& node,
                              document::Problems& problems) {
  RegisterMap map;
  MapReader top(document, node, problems, "registers");
  Reader reader(document, problems, map);
  reader.block(top, Block::command, "command");
  reader.block(top, Block::status, "status");
  reader.block(top, Block::finger, "finger");
  const Node* const fingers = top.child("fingers", true);
  if (fingers == nullptr) return map;
  MapReader fingers_reader(document, *fingers, problems, "registers: fingers");
  map.first_finger = static_cast<std::uint16_t>(fingers_reader.integer("first", {0, last_address}));
  map.finger_stride = static_cast<std::uint16_t>(fingers_reader.integer("each", {1, last_address}));
  map.most_fingers = static_cast<std::uint16_t>(fingers_reader.integer("most", {1, most_fingers}));
  if (!problems.empty()) return map;
  for (std::size_t finger = 0; finger < map.most_fingers; ++finger) {
    for (const RegisterInfo& info : table) {
      if (info.block != Block::finger) continue;
      const std::int64_t address = std::int64_t{map.first_finger} +
                                   std::int64_t{map.finger_stride} * static_cast<std::int64_t>(finger) +
                                   map.at(info.name);
      reader.claim(fingers->at, address, fmt::format("{} of finger {}", info.key, finger + 1));
    }
  }
  return map;
}

}  // namespace softgrip::plc
